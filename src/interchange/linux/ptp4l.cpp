#include "interchange/linux/ptp4l.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>

#include "interchange/linux/meaning.hpp"
#include "json/quantity.hpp"
#include "json/suggest.hpp"
#include "scenario/resolve/gptp_links.hpp"

namespace takt::interchange::linux_tc {
namespace {

using sim::Duration;

enum class ValueKind : std::uint8_t { whole, real, text };

/// What a reader has at hand when a key sets something.
struct Target {
  scenario::Gptp& gptp;
  scenario::GptpNode& node;
  scenario::Clock& clock;
  bool& has_clock;
  bool& never_grandmaster;
  bool& receiver_only;
  bool& is_gptp;
};

struct Key {
  std::string_view name;
  ValueKind kind = ValueKind::whole;
  double least = 0, most = 0;
  void (*set)(Target& target, double value, const std::string& text) = nullptr;   ///< null: has no meaning in takt
};

constexpr double any = 2147483647;

const std::vector<Key>& keys() {
  static const std::vector<Key> all = {
      {"logSyncInterval", ValueKind::whole, -128, 127, [](Target& t, double v, const std::string&) { t.gptp.log_sync_interval = static_cast<std::int8_t>(v); }},
      {"logAnnounceInterval", ValueKind::whole, -128, 127, [](Target& t, double v, const std::string&) { t.gptp.log_announce_interval = static_cast<std::int8_t>(v); }},
      {"logMinPdelayReqInterval", ValueKind::whole, -128, 127, [](Target& t, double v, const std::string&) { t.gptp.log_pdelay_interval = static_cast<std::int8_t>(v); }},
      {"syncReceiptTimeout", ValueKind::whole, 0, 255, [](Target& t, double v, const std::string&) { t.gptp.sync_receipt_timeout = static_cast<std::uint8_t>(v); }},
      {"announceReceiptTimeout", ValueKind::whole, 2, 255, [](Target& t, double v, const std::string&) { t.gptp.announce_receipt_timeout = static_cast<std::uint8_t>(v); }},
      {"neighborPropDelayThresh", ValueKind::whole, 0, any, [](Target& t, double v, const std::string&) { t.gptp.link_delay_threshold = Duration::from_ps(static_cast<std::int64_t>(v) * 1000); }},
      {"priority1", ValueKind::whole, 0, 255, [](Target& t, double v, const std::string&) { t.node.priority1 = static_cast<std::uint8_t>(v); }},
      {"priority2", ValueKind::whole, 0, 255, [](Target& t, double v, const std::string&) { t.node.priority2 = static_cast<std::uint8_t>(v); }},
      {"clockClass", ValueKind::whole, 0, 255, [](Target& t, double v, const std::string&) { t.node.clock_class = static_cast<std::uint8_t>(v); }},
      {"clockAccuracy", ValueKind::whole, 0, 255, [](Target& t, double v, const std::string&) { t.node.clock_accuracy = static_cast<std::uint8_t>(v); }},
      {"gmCapable", ValueKind::whole, 0, 1, [](Target& t, double v, const std::string&) { t.never_grandmaster = v == 0; }},
      {"slaveOnly", ValueKind::whole, 0, 1, [](Target& t, double v, const std::string&) { t.receiver_only = v != 0; }},
      {"twoStepFlag", ValueKind::whole, 0, 1, [](Target& t, double v, const std::string&) { t.gptp.one_step = v == 0; }},
      {"clock_servo", ValueKind::text, 0, 0, [](Target& t, double, const std::string&) { t.gptp.servo.algorithm = scenario::ServoAlgorithm::pi; }},
      {"first_step_threshold", ValueKind::real, 0, 1e9, [](Target& t, double v, const std::string&) { t.gptp.servo.first_step_threshold = Duration::from_ps(std::llround(v * 1e12)); }},
      {"step_threshold", ValueKind::real, 0, 1e9, [](Target& t, double v, const std::string&) { t.gptp.servo.step_threshold = Duration::from_ps(std::llround(v * 1e12)); }},
      {"max_frequency", ValueKind::whole, 0, any, [](Target& t, double v, const std::string&) { t.gptp.servo.max_frequency = {static_cast<std::int64_t>(v) * 1000}; }},
      {"egressLatency", ValueKind::whole, -any, any, [](Target& t, double v, const std::string&) { t.clock.tx_correction = Duration::from_ps(static_cast<std::int64_t>(v) * 1000); t.has_clock = true; }},
      {"ingressLatency", ValueKind::whole, -any, any, [](Target& t, double v, const std::string&) { t.clock.rx_correction = Duration::from_ps(static_cast<std::int64_t>(v) * 1000); t.has_clock = true; }},
      {"transportSpecific", ValueKind::whole, 0, 15, [](Target& t, double v, const std::string&) { t.is_gptp = v == 1; }},
      // What has no key in takt, or the only value that it has.
      {"domainNumber", ValueKind::whole, 0, 127}, {"offsetScaledLogVariance", ValueKind::whole, 0, 65535}, {"min_neighbor_prop_delay", ValueKind::whole, -any, any},
      {"assume_two_step", ValueKind::whole, 0, 1}, {"path_trace_enabled", ValueKind::whole, 0, 1}, {"follow_up_info", ValueKind::whole, 0, 1}, {"ptp_dst_mac", ValueKind::text},
      {"p2p_dst_mac", ValueKind::text}, {"network_transport", ValueKind::text}, {"delay_mechanism", ValueKind::text}, {"boundary_clock_jbod", ValueKind::whole, 0, 1},
      {"pi_proportional_const", ValueKind::real, 0, any}, {"pi_integral_const", ValueKind::real, 0, any}, {"pi_proportional_scale", ValueKind::real, 0, any}, {"pi_proportional_exponent", ValueKind::real, -any, any},
      {"pi_proportional_norm_max", ValueKind::real, 0, 1}, {"pi_integral_scale", ValueKind::real, 0, any}, {"pi_integral_exponent", ValueKind::real, -any, any}, {"pi_integral_norm_max", ValueKind::real, 0, 2},
      {"masterOnly", ValueKind::whole, 0, 1}, {"BMCA", ValueKind::text}, {"inhibit_announce", ValueKind::whole, 0, 1}, {"inhibit_multicast_service", ValueKind::whole, 0, 1}, {"inhibit_delay_req", ValueKind::whole, 0, 1},
      {"asCapable", ValueKind::text}, {"ignore_source_id", ValueKind::whole, 0, 1}, {"time_stamping", ValueKind::text}, {"tx_timestamp_timeout", ValueKind::whole, 1, any}, {"summary_interval", ValueKind::whole, -any, any},
      {"logging_level", ValueKind::whole, 0, 7}, {"verbose", ValueKind::whole, 0, 1}, {"use_syslog", ValueKind::whole, 0, 1}, {"free_running", ValueKind::whole, 0, 1}, {"freq_est_interval", ValueKind::whole, 0, any},
      {"fault_reset_interval", ValueKind::text}, {"fault_badpeernet_interval", ValueKind::text}, {"delayAsymmetry", ValueKind::whole, -any, any}, {"delay_filter", ValueKind::text}, {"delay_filter_length", ValueKind::whole, 1, any},
      {"dataset_comparison", ValueKind::text}, {"G.8275.defaultDS.localPriority", ValueKind::whole, 1, 255}, {"G.8275.portDS.localPriority", ValueKind::whole, 1, 255}, {"maxStepsRemoved", ValueKind::whole, 2, 255},
      {"logMinDelayReqInterval", ValueKind::whole, -128, 127}, {"operLogSyncInterval", ValueKind::whole, -128, 127}, {"operLogPdelayReqInterval", ValueKind::whole, -128, 127}, {"msg_interval_request", ValueKind::whole, 0, 1},
      {"hybrid_e2e", ValueKind::whole, 0, 1}, {"net_sync_monitor", ValueKind::whole, 0, 1}, {"tc_spanning_tree", ValueKind::whole, 0, 1}, {"kernel_leap", ValueKind::whole, 0, 1}, {"check_fup_sync", ValueKind::whole, 0, 1},
      {"clock_type", ValueKind::text}, {"sanity_freq_limit", ValueKind::whole, 0, any}, {"servo_num_offset_values", ValueKind::whole, 0, any}, {"servo_offset_threshold", ValueKind::whole, 0, any}, {"utc_offset", ValueKind::whole, 0, 32767},
      {"timeSource", ValueKind::whole, 0, 254}, {"uds_address", ValueKind::text}, {"udp_ttl", ValueKind::whole, 1, 255}, {"udp6_scope", ValueKind::whole, 0, 15}, {"dscp_event", ValueKind::whole, 0, 63}, {"dscp_general", ValueKind::whole, 0, 63},
      {"socket_priority", ValueKind::whole, 0, 15}, {"productDescription", ValueKind::text}, {"revisionData", ValueKind::text}, {"manufacturerIdentity", ValueKind::text}, {"userDescription", ValueKind::text}, {"clockIdentity", ValueKind::text},
      {"neighborPropDelay", ValueKind::whole, 0, any}, {"hwts_filter", ValueKind::text}, {"tsproc_mode", ValueKind::text}, {"write_phase_mode", ValueKind::whole, 0, 1}, {"unicast_listen", ValueKind::whole, 0, 1},
  };
  return all;
}

/// A whole number, decimal or hexadecimal, or a fraction; null if it is none of the kind.
std::optional<double> number(std::string_view text, ValueKind kind) {
  if (kind == ValueKind::real) {
    double value = 0;
    const auto [stop, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    return error == std::errc() && stop == text.data() + text.size() && std::isfinite(value) ? std::optional(value) : std::nullopt;
  }
  int base = 10;
  if (text.starts_with("0x") || text.starts_with("0X")) { text.remove_prefix(2); base = 16; }
  std::int64_t value = 0;
  const auto [stop, error] = std::from_chars(text.data(), text.data() + text.size(), value, base);
  return error == std::errc() && !text.empty() && stop == text.data() + text.size() ? std::optional(static_cast<double>(value)) : std::nullopt;
}

class Ptp4lReader {
 public:
  Ptp4lReader(const InputFile& file, ImportedDevice& device, Imported& imported, json::Diagnostics& diagnostics) : file_(file), device_(device), imported_(imported), diagnostics_(diagnostics) {}

  void run() {
    std::string_view rest = file_.text;
    for (line_ = 1; !rest.empty(); ++line_) {
      const std::size_t end = rest.find('\n');
      read_line(rest.substr(0, end));
      rest.remove_prefix(end == std::string_view::npos ? rest.size() : end + 1);
    }
    const json::Place whole{file_.name, 0, 0, ""};
    if (never_grandmaster_ && receiver_only_) diagnostics_.error(whole, "two ways at once to be no grandmaster", {"gmCapable 0 and slaveOnly 1", "gmCapable 0 alone, which is that of IEEE 802.1AS"});
    if (!is_gptp_) imported_.remark(RemarkKind::lost, whole, "not gPTP (transportSpecific 0x1 is not set): takt speaks IEEE 802.1AS");
    if (never_grandmaster_ || receiver_only_) node_.priority1 = 255;
    if (gptp_.servo.algorithm == scenario::ServoAlgorithm::drift_tracking) gptp_.servo.algorithm = scenario::ServoAlgorithm::pi;
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
    const auto place = [&](std::size_t column) { return json::Place{file_.name, line_, static_cast<std::uint32_t>(column + 1), ""}; };
    if (line[at] == '[') {
      const std::size_t close = line.find(']', at);
      if (close == std::string_view::npos) diagnostics_.error(place(at), "a section that does not end", {json::quote(line.substr(at)), "[global] or [INTERFACE]"});
      else section_ = std::string(line.substr(at + 1, close - at - 1));
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
    if (section_.empty()) return diagnostics_.error(place(at), "a line in no section", {json::quote(name), "[global] or [INTERFACE] before it"});
    const auto key = std::ranges::find(keys(), name, &Key::name);
    if (key == keys().end()) {
      std::vector<std::string_view> names;
      for (const Key& each : keys()) names.push_back(each.name);
      const bool is_of_version_4 = name == "serverOnly" || name == "clientOnly";
      return diagnostics_.error(place(at), "unknown option", {json::quote(name), is_of_version_4 ? "the name of linuxptp 3 (version 4 has others)" : "an option of ptp4l",
                                                              name == "serverOnly" ? "masterOnly" : name == "clientOnly" ? "slaveOnly" : json::suggest(name, names)});
    }
    double read = 0;
    if (key->kind != ValueKind::text) {
      const auto parsed = number(value, key->kind);
      if (!parsed) return diagnostics_.error(place(value_at), "malformed value", {json::quote(value) + " for " + std::string(name), key->kind == ValueKind::whole ? "a whole number without a unit" : "a number without a unit"});
      if (*parsed < key->least || *parsed > key->most) return diagnostics_.error(place(value_at), "a value out of range", {value + " for " + std::string(name), fmt::format("{:.0f} to {:.0f}", key->least, key->most)});
      read = *parsed;
    }
    if (name == "delay_mechanism" && value != "P2P" && value != "p2p") return diagnostics_.error(place(value_at), "a way to measure delays that gPTP does not have", {json::quote(value), "P2P"});
    if (name == "network_transport" && value != "L2") return diagnostics_.error(place(value_at), "a transport that gPTP does not have", {json::quote(value), "L2"});
    if (name == "clock_servo" && value != "pi") return diagnostics_.error(place(value_at), "a servo that takt does not have", {json::quote(value), "pi"});
    if (name == "domainNumber" && read != 0) return diagnostics_.error(place(value_at), "a further domain", {"domain " + value, "domain 0, the only one that is read"});
    if (section_ != "global" && (name == "egressLatency" || name == "ingressLatency")) imported_.remark(RemarkKind::lost, place(at), std::string(name) + " of " + section_ + " alone: takt has it of the node");
    if (key->set == nullptr) {
      if (name == "offsetScaledLogVariance") imported_.remark(RemarkKind::ignored, place(at), "offsetScaledLogVariance has no key in takt");
      return;
    }
    Target target{gptp_, node_, clock_, has_clock_, never_grandmaster_, receiver_only_, is_gptp_};
    key->set(target, read, value);
  }

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
};

/// Where the scenario says none: that of copper, or where there is fibre, which has none, that which ptp4l has by default.
Duration default_threshold(const scenario::Resolved& resolved) {
  const scenario::Gptp& gptp = *resolved.scenario.clocks.gptp;
  const bool has_fibre = std::ranges::any_of(resolved.plan.links, [&](const models::LinkPlan& link) { return !scenario::link_delay_threshold(gptp, link); });
  return has_fibre ? Duration::from_ps(20'000'000'000) : Duration::from_ps(800'000);
}

}  // namespace

void read_ptp4l(const InputFile& file, ImportedDevice& device, Imported& imported, json::Diagnostics& diagnostics) { Ptp4lReader(file, device, imported, diagnostics).run(); }

std::vector<Ptp4lFile> ptp4l_files(const scenario::Resolved& resolved, const Device& device, Exported& exported) {
  std::vector<Ptp4lFile> files;
  if (!resolved.scenario.clocks.gptp) return files;
  const scenario::Gptp& gptp = *resolved.scenario.clocks.gptp;
  if (std::ranges::find(gptp.without, device.name) != gptp.without.end()) return files;
  const auto node_in = [&](const json::NameMap<scenario::GptpNode>& nodes) {
    const auto found = std::ranges::find(nodes, device.name, [](const auto& each) -> const std::string& { return each.first; });
    return found == nodes.end() ? scenario::GptpNode{} : found->second;
  };
  std::vector<std::pair<std::uint8_t, scenario::GptpNode>> domains;
  domains.emplace_back(std::uint8_t{0}, node_in(gptp.nodes));
  for (const scenario::GptpDomain& domain : gptp.domains) domains.emplace_back(domain.domain, node_in(domain.nodes));
  const auto lose = [&](bool is_said, const char* what) { if (is_said) exported.lose("clock of " + device.name, what); };
  lose(gptp.hot_standby, "hot standby (IEEE 802.1ASdm): ptp4l runs each domain by itself");
  lose(gptp.drift_tracking, "the Drift_Tracking TLV");
  lose(gptp.boundary, "boundary clocks");
  lose(gptp.servo.algorithm != scenario::ServoAlgorithm::pi, "a servo other than pi");
  lose(!gptp.interval_requests.empty(), "interval requests of neighbours");
  lose(gptp.rate_ratio_window != 8 || gptp.average_link_delay != 1 || gptp.drift_window != 0, "windows of rate ratios and link delays");

  for (const auto& [domain, node] : domains) {
    std::string text = fmt::format("# takt: gPTP of {} in scenario {}\n[global]\n", device.name, resolved.scenario.name);
    const auto add = [&](std::string_view key, const std::string& value) { text += fmt::format("{:<24}{}\n", key, value); };
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
    if (threshold.ps() % 1000 != 0) exported.lose("clock of " + device.name, "a link delay threshold that is no whole number of ns");
    add("neighborPropDelayThresh", std::to_string(threshold.ps() / 1000));
    if (gptp.one_step) add("twoStepFlag", "0");
    add("time_stamping", gptp.one_step ? "onestep" : "hardware");
    add("clock_servo", "pi");
    add("first_step_threshold", fmt::format("{:.12f}", static_cast<double>(gptp.servo.first_step_threshold.ps()) * 1e-12));
    add("step_threshold", fmt::format("{:.12f}", static_cast<double>(gptp.servo.step_threshold.ps()) * 1e-12));
    add("max_frequency", std::to_string(gptp.servo.max_frequency.parts_per_trillion / 1000));
    for (const auto& [key, value] : {std::pair("transportSpecific", "0x1"), {"ptp_dst_mac", "01:80:C2:00:00:0E"}, {"network_transport", "L2"}, {"delay_mechanism", "P2P"}, {"follow_up_info", "1"},
                                     {"path_trace_enabled", "1"}, {"assume_two_step", "1"}, {"min_neighbor_prop_delay", "-20000000"}})
      add(key, value);
    if (node.roles) add("BMCA", "noop");
    if (device.ports.size() > 1) add("boundary_clock_jbod", "1");
    const auto clock = std::ranges::find(resolved.scenario.clocks.nodes, device.name, [](const auto& each) -> const std::string& { return each.first; });
    const scenario::Clock* const own = clock != resolved.scenario.clocks.nodes.end() ? &clock->second : resolved.scenario.clocks.all ? &*resolved.scenario.clocks.all : nullptr;
    for (const DevicePort& port : device.ports) {
      text += "\n[" + port.interface + "]\n";
      if (own != nullptr && own->tx_correction) add("egressLatency", std::to_string(own->tx_correction->ps() / 1000));
      if (own != nullptr && own->rx_correction) add("ingressLatency", std::to_string(own->rx_correction->ps() / 1000));
      if (!node.roles) continue;
      const auto role = std::ranges::find(*node.roles, port.peer_name, &scenario::GptpPortRole::to);
      if (role == node.roles->end()) continue;
      if (role->role == scenario::GptpRole::time_transmitter) add("masterOnly", "1");
      else if (role->role != scenario::GptpRole::time_receiver) exported.lose("clock of " + device.name, "the role " + std::string(scenario::spelling(role->role)) + " of " + port.interface);
    }
    files.push_back({domain, std::move(text)});
  }
  return files;
}

}  // namespace takt::interchange::linux_tc
