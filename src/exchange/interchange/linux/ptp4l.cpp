// SPDX-License-Identifier: Apache-2.0
#include "interchange/linux/ptp4l.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>

#include "interchange/linux/meaning.hpp"
#include "interchange/linux/ptp4l_keys.hpp"
#include "json/printable.hpp"
#include "json/quantity.hpp"
#include "json/suggest.hpp"
#include "scenario/resolve/gptp_links.hpp"

namespace takt::interchange::linux_tc {
namespace {

using sim::Duration;

/// A whole number, decimal or hexadecimal, or a fraction; null if it is none of the kind.
std::optional<double> number(std::string_view text, ValueKind kind) {
  if (kind == ValueKind::real) {
    double value = 0;
    const auto [stop, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    return error == std::errc() && stop == text.data() + text.size() && std::isfinite(value) ? std::optional(value)
                                                                                             : std::nullopt;
  }
  int base = 10;
  if (text.starts_with("0x") || text.starts_with("0X")) {
    text.remove_prefix(2);
    base = 16;
  }
  std::int64_t value = 0;
  const auto [stop, error] = std::from_chars(text.data(), text.data() + text.size(), value, base);
  return error == std::errc() && !text.empty() && stop == text.data() + text.size()
             ? std::optional(static_cast<double>(value))
             : std::nullopt;
}

class Ptp4lReader {
 public:
  Ptp4lReader(const InputFile& file, ImportedDevice& device, Imported& imported, json::Diagnostics& diagnostics)
      : file_(file), device_(device), imported_(imported), diagnostics_(diagnostics) {}

  /// Where a file is silent, linuxptp's defaults hold, which are not those of IEEE 802.1AS.
  void run() {
    node_.priority1 = 128;
    node_.priority2 = 128;
    node_.clock_class = 248;
    node_.clock_accuracy = 0xFE;
    gptp_.log_sync_interval = 0;
    gptp_.log_announce_interval = 1;
    gptp_.log_pdelay_interval = 0;
    gptp_.sync_receipt_timeout = 0;
    gptp_.announce_receipt_timeout = 3;
    gptp_.link_delay_threshold = Duration::from_ps(20'000'000'000);
    gptp_.servo.first_step_threshold = Duration::from_ps(20'000'000);
    gptp_.servo.step_threshold = Duration();
    gptp_.servo.max_frequency = {900'000'000'000};
    std::string_view rest = file_.text;
    for (line_ = 1; !rest.empty(); ++line_) {
      const std::size_t end = rest.find('\n');
      read_line(rest.substr(0, end));
      rest.remove_prefix(end == std::string_view::npos ? rest.size() : end + 1);
    }
    const json::Place whole{file_.name, 0, 0, ""};
    if (never_grandmaster_ && receiver_only_)
      diagnostics_.error(whole, "two ways at once to be no grandmaster",
                         {"gmCapable 0 and slaveOnly 1", "gmCapable 0 alone, which is that of IEEE 802.1AS"});
    if (!is_gptp_)
      imported_.remark(RemarkKind::lost, whole,
                       "not gPTP (transportSpecific 0x1 is not set): takt speaks IEEE 802.1AS");
    if (!says_mechanism_)
      imported_.remark(RemarkKind::lost, whole,
                       "delays measured end to end, as ptp4l does it where the file is silent: takt measures each link "
                       "(delay_mechanism P2P)");
    if (!says_transport_)
      imported_.remark(RemarkKind::lost, whole,
                       "messages over UDP, as ptp4l sends them where the file is silent: takt's are Ethernet frames "
                       "(network_transport L2)");
    if (gptp_.sync_receipt_timeout < least_timeout) {
      if (gptp_.sync_receipt_timeout == 0)
        imported_.remark(
            RemarkKind::lost, whole,
            "no time-out of Sync (syncReceiptTimeout 0, linuxptp's default): takt takes 3 intervals, as IEEE 802.1AS");
      else
        imported_.remark(RemarkKind::lost, whole, "a time-out of Sync after one interval: takt takes 3");
      gptp_.sync_receipt_timeout = 3;
    }
    set_roles();
    if (never_grandmaster_ || receiver_only_) node_.priority1 = 255;
    if (gptp_.servo.algorithm == scenario::ServoAlgorithm::drift_tracking)
      gptp_.servo.algorithm = scenario::ServoAlgorithm::pi;
    device_.gptp = node_;
    device_.gptp_of_all = gptp_;
    if (has_clock_) device_.clock = clock_;
  }

 private:
  void read_line(std::string_view line) {
    const auto is_blank = [](char c) { return c == ' ' || c == '\t' || c == '\r'; };
    std::size_t at = 0;
    while (at < line.size() && is_blank(line[at])) ++at;
    if (at == line.size() || line[at] == '#') return;
    const auto place = [&](std::size_t column) {
      return json::Place{file_.name, line_, static_cast<std::uint32_t>(column + 1), ""};
    };
    if (line[at] == '[') {
      const std::size_t close = line.find(']', at);
      if (close == std::string_view::npos)
        diagnostics_.error(place(at), "a section that does not end",
                           {json::quote(line.substr(at)), "[global] or [INTERFACE]"});
      else {
        section_ = std::string(line.substr(at + 1, close - at - 1));
        if (section_ == "unicast_master_table")
          imported_.remark(RemarkKind::lost, place(at), "unicast messages: takt's gPTP is multicast");
        else if (section_ != "global" && std::ranges::find(interfaces_, section_) == interfaces_.end())
          interfaces_.push_back(section_);
      }
      return;
    }
    std::size_t key_end = at;
    while (key_end < line.size() && !is_blank(line[key_end])) ++key_end;
    std::size_t value_at = key_end;
    while (value_at < line.size() && is_blank(line[value_at])) ++value_at;
    std::size_t value_end = line.size();
    while (value_end > value_at && is_blank(line[value_end - 1])) --value_end;
    const std::string_view name = line.substr(at, key_end - at);
    const std::string value(line.substr(value_at, value_end - value_at));
    if (section_.empty())
      return diagnostics_.error(place(at), "a line in no section",
                                {json::quote(name), "[global] or [INTERFACE] before it"});
    const std::span<const Key> keys = ptp4l_keys();
    const auto key = std::ranges::find(keys, ptp4l_key(name), &Key::name);
    if (key == keys.end()) {
      std::vector<std::string_view> names;
      for (const Key& each : keys) names.push_back(each.name);
      return diagnostics_.error(place(at), "unknown option",
                                {json::quote(name), "an option of ptp4l", json::suggest(name, names)});
    }
    double read = 0;
    if (key->kind != ValueKind::text) {
      const auto parsed = number(value, key->kind);
      if (!parsed)
        return diagnostics_.error(
            place(value_at), "malformed value",
            {json::quote(value) + " for " + std::string(name),
             key->kind == ValueKind::whole ? "a whole number without a unit" : "a number without a unit"});
      if (*parsed < key->least || *parsed > key->most)
        return diagnostics_.error(
            place(value_at), "a value out of range",
            {value + " for " + std::string(name), fmt::format("{:.0f} to {:.0f}", key->least, key->most)});
      read = *parsed;
    }
    if (name == "delay_mechanism" && value != "P2P" && value != "p2p")
      return diagnostics_.error(place(value_at), "a way to measure delays that gPTP does not have",
                                {json::quote(value), "P2P"});
    if (name == "network_transport" && value != "L2")
      return diagnostics_.error(place(value_at), "a transport that gPTP does not have", {json::quote(value), "L2"});
    if (name == "clock_servo" && value != "pi")
      return diagnostics_.error(place(value_at), "a servo that takt does not have", {json::quote(value), "pi"});
    if (name == "domainNumber" && read != 0)
      return diagnostics_.error(place(value_at), "a further domain",
                                {"domain " + value, "domain 0, the only one that is read"});
    if (section_ != "global" && (name == "egressLatency" || name == "ingressLatency"))
      imported_.remark(RemarkKind::lost, place(at),
                       std::string(name) + " of " + section_ + " alone: takt has it of the node");
    says_mechanism_ = says_mechanism_ || name == "delay_mechanism";
    says_transport_ = says_transport_ || name == "network_transport";
    if (key->set == nullptr) return judge(*key, read, value, place(at));
    Target target{gptp_, node_, clock_, has_clock_, never_grandmaster_, receiver_only_, is_gptp_};
    key->set(target, read, value);
  }

  /// A key that sets nothing in takt.
  void judge(const Key& key, double read, const std::string& value, const json::Place& place) {
    if (key.name == "BMCA") {
      if (value == "noop")
        has_fixed_roles_ = true;
      else if (value != "ptp")
        diagnostics_.error(place, "malformed value", {json::quote(value) + " for BMCA", "ptp or noop"});
    } else if (key.name == "masterOnly") {
      if (section_ == "global")
        transmits_by_default_ = read != 0;
      else if (read != 0)
        transmitters_.emplace_back(section_, place);
      if (read != 0) first_transmitter_ = first_transmitter_.value_or(place);
    } else if (key.name == "offsetScaledLogVariance") {
      imported_.remark(RemarkKind::ignored, place, "offsetScaledLogVariance has no key in takt");
    } else if (!key.otherwise.empty() && !is_usual(key, read, value)) {
      imported_.remark(RemarkKind::lost, place,
                       std::string(key.name) + " " + value + ": " + std::string(key.otherwise));
    }
  }

  /// Ports whose roles BMCA does not choose.
  void set_roles() {
    if (!has_fixed_roles_) {
      if (first_transmitter_)
        imported_.remark(RemarkKind::lost, *first_transmitter_,
                         "a port that never follows (masterOnly, serverOnly) beside BMCA: takt's BMCA may let it");
      return;
    }
    node_.roles.emplace();
    for (const std::string& interface : interfaces_) {
      scenario::GptpPortRole role;
      role.to = interface;
      const bool transmits = transmits_by_default_ || std::ranges::any_of(transmitters_, [&](const auto& each) {
                               return each.first == interface;
                             });
      role.role = transmits ? scenario::GptpRole::time_transmitter : scenario::GptpRole::time_receiver;
      node_.roles->push_back(std::move(role));
      if (std::ranges::none_of(device_.ports, [&](const ImportedPort& port) { return port.interface == interface; }))
        device_.ports.push_back({interface, {file_.name, 0, 0, ""}, {}, {}, {}});
    }
    if (interfaces_.empty())
      imported_.remark(RemarkKind::lost, {file_.name, 0, 0, ""},
                       "roles that BMCA does not choose (BMCA noop), of interfaces that the file does not name");
    device_.gptp_by_roles = true;
  }

  static constexpr std::uint8_t least_timeout = 2;
  const InputFile& file_;
  ImportedDevice& device_;
  Imported& imported_;
  json::Diagnostics& diagnostics_;
  std::uint32_t line_ = 1;
  std::string section_;
  scenario::Gptp gptp_;
  scenario::GptpNode node_;
  scenario::Clock clock_;
  bool has_clock_ = false, never_grandmaster_ = false, receiver_only_ = false, is_gptp_ = false;
  bool says_mechanism_ = false, says_transport_ = false, has_fixed_roles_ = false, transmits_by_default_ = false;
  std::optional<json::Place> first_transmitter_;
  std::vector<std::string> interfaces_;
  std::vector<std::pair<std::string, json::Place>> transmitters_;
};

/// Where the scenario says none: that of copper, or where there is fibre, which has none, that which ptp4l has by
/// default.
Duration default_threshold(const scenario::Resolved& resolved) {
  const scenario::Gptp& gptp = *resolved.scenario.clocks.gptp;
  const bool has_fibre = std::ranges::any_of(
      resolved.plan.links, [&](const models::LinkPlan& link) { return !scenario::link_delay_threshold(gptp, link); });
  return has_fibre ? Duration::from_ps(20'000'000'000) : Duration::from_ps(800'000);
}

}  // namespace

void read_ptp4l(const InputFile& file, ImportedDevice& device, Imported& imported, json::Diagnostics& diagnostics) {
  Ptp4lReader(file, device, imported, diagnostics).run();
}

std::vector<Ptp4lFile> ptp4l_files(const scenario::Resolved& resolved, const Device& device, bool in_software,
                                   Exported& exported) {
  std::vector<Ptp4lFile> files;
  if (!resolved.scenario.clocks.gptp) return files;
  const scenario::Gptp& gptp = *resolved.scenario.clocks.gptp;
  if (std::ranges::find(gptp.without, device.name) != gptp.without.end()) return files;
  const auto node_in = [&](const json::NameMap<scenario::GptpNode>& nodes) {
    const auto found =
        std::ranges::find(nodes, device.name, [](const auto& each) -> const std::string& { return each.first; });
    return found == nodes.end() ? scenario::GptpNode{} : found->second;
  };
  std::vector<std::pair<std::uint8_t, scenario::GptpNode>> domains;
  domains.emplace_back(std::uint8_t{0}, node_in(gptp.nodes));
  for (const scenario::GptpDomain& domain : gptp.domains) domains.emplace_back(domain.domain, node_in(domain.nodes));
  const auto lose = [&](bool is_said, const char* what) {
    if (is_said) exported.lose("clock of " + device.name, what);
  };
  lose(gptp.hot_standby, "hot standby (IEEE 802.1ASdm): ptp4l runs each domain by itself");
  lose(gptp.drift_tracking, "the Drift_Tracking TLV");
  lose(gptp.boundary, "boundary clocks");
  lose(gptp.servo.algorithm != scenario::ServoAlgorithm::pi, "a servo other than pi");
  lose(!gptp.interval_requests.empty(), "interval requests of neighbours");
  lose(gptp.rate_ratio_window != 8 || gptp.average_link_delay != 1 || gptp.drift_window != 0,
       "windows of rate ratios and link delays");

  for (const auto& [domain, node] : domains) {
    std::string text = fmt::format("# takt: gPTP of {} in scenario {}\n[global]\n", json::printable(device.name),
                                   json::printable(resolved.scenario.name));
    const auto add = [&](std::string_view key, const std::string& value) {
      text += fmt::format("{:<24}{}\n", key, value);
    };
    const std::uint8_t priority1 = node.priority1.value_or(gptp.hot_standby ? 255 : 248);
    add("domainNumber", std::to_string(domain));
    add("gmCapable", priority1 == 255 ? "0" : "1");
    add("priority1", std::to_string(priority1));
    add("priority2", std::to_string(node.priority2));
    add("clockClass", std::to_string(node.clock_class));
    add("clockAccuracy", fmt::format("{:#x}", node.clock_accuracy));
    add("logAnnounceInterval", std::to_string(gptp.log_announce_interval));
    add("logSyncInterval", std::to_string(gptp.log_sync_interval));
    add("logMinPdelayReqInterval", std::to_string(gptp.log_pdelay_interval));
    add("syncReceiptTimeout", std::to_string(gptp.sync_receipt_timeout));
    add("announceReceiptTimeout", std::to_string(gptp.announce_receipt_timeout));
    const Duration threshold = gptp.link_delay_threshold.value_or(default_threshold(resolved));
    if (threshold.ps() % 1000 != 0)
      exported.lose("clock of " + device.name, "a link delay threshold that is no whole number of ns");
    add("neighborPropDelayThresh", std::to_string(threshold.ps() / 1000));
    if (gptp.one_step) add("twoStepFlag", "0");
    if (gptp.one_step && in_software)
      exported.lose("clock of " + device.name, "one-step Sync, which the kernel cannot send");
    add("time_stamping", in_software ? "software" : gptp.one_step ? "onestep" : "hardware");
    add("clock_servo", "pi");
    add("first_step_threshold",
        fmt::format("{:.12f}", static_cast<double>(gptp.servo.first_step_threshold.ps()) * 1e-12));
    add("step_threshold", fmt::format("{:.12f}", static_cast<double>(gptp.servo.step_threshold.ps()) * 1e-12));
    add("max_frequency", std::to_string(gptp.servo.max_frequency.parts_per_trillion / 1000));
    for (const auto& [key, value] : {std::pair("transportSpecific", "0x1"),
                                     {"ptp_dst_mac", "01:80:C2:00:00:0E"},
                                     {"network_transport", "L2"},
                                     {"delay_mechanism", "P2P"},
                                     {"follow_up_info", "1"},
                                     {"path_trace_enabled", "1"},
                                     {"assume_two_step", "1"},
                                     {"min_neighbor_prop_delay", "-20000000"}})
      add(key, value);
    if (node.roles) add("BMCA", "noop");
    // Interfaces with a clock each; with time stamps of software ptp4l would switch to a clock that is not there.
    if (device.ports.size() > 1 && !in_software) add("boundary_clock_jbod", "1");
    const auto clock = std::ranges::find(resolved.scenario.clocks.nodes, device.name,
                                         [](const auto& each) -> const std::string& { return each.first; });
    const scenario::Clock* const own = clock != resolved.scenario.clocks.nodes.end() ? &clock->second
                                       : resolved.scenario.clocks.all                ? &*resolved.scenario.clocks.all
                                                                                     : nullptr;
    for (const DevicePort& port : device.ports) {
      text += "\n[" + port.interface + "]\n";
      if (own != nullptr && own->tx_correction) add("egressLatency", std::to_string(own->tx_correction->ps() / 1000));
      if (own != nullptr && own->rx_correction) add("ingressLatency", std::to_string(own->rx_correction->ps() / 1000));
      if (!node.roles) continue;
      const auto role = std::ranges::find(*node.roles, port.peer_name, &scenario::GptpPortRole::to);
      if (role == node.roles->end()) continue;
      if (role->role == scenario::GptpRole::time_transmitter)
        add("masterOnly", "1");
      else if (role->role != scenario::GptpRole::time_receiver)
        exported.lose("clock of " + device.name,
                      "the role " + std::string(scenario::spelling(role->role)) + " of " + port.interface);
    }
    files.push_back({domain, std::move(text)});
  }
  return files;
}

}  // namespace takt::interchange::linux_tc
