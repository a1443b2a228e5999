// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <numeric>

#include "interchange/device_import.hpp"
#include "interchange/gate_times.hpp"
#include "interchange/ports.hpp"
#include "interchange/yang/gptp.hpp"
#include "interchange/yang/limits.hpp"
#include "interchange/yang/modules.hpp"
#include "interchange/yang/policing_export.hpp"
#include "interchange/yang/yang.hpp"
#include "models/egress/gate_control_list.hpp"

namespace takt::interchange {
namespace yang {
namespace {

using models::TrafficClass;
using sim::Duration;

/// Limits by device and interface.
using Limits = std::map<std::string, std::map<std::string, PortLimits>>;

class NodeWriter {
 public:
  NodeWriter(const ExportRequest& request, const Device& device, const Limits& limits, Exported& exported)
      : r_(request.resolved),
        device_(device),
        exported_(exported),
        dialect_(request.settings["dialect"] == "2018" ? Dialect::of_2018 : Dialect::published),
        start_(request.settings.number("start", 9'000'000'000'000'000'000ULL).value_or(0)) {
    if (const auto found = limits.find(device.name); found != limits.end()) limits_ = &found->second;
  }

  Data write() {
    Data root{&root_of(dialect_), {}, {}, {}, false};
    Data& interfaces = root.make("interfaces");
    for (const DevicePort& port : device_.ports) write_port(interfaces.add("interface"), port);
    write_gptp(root, r_, device_, dialect_, exported_);
    if (device_.ingress != nullptr) write_policing(root, r_, device_, dialect_, start_, exported_);
    write_redundancy(root, r_, device_, dialect_, exported_);
    if (std::ranges::any_of(r_.plan.talker_ats, [&](const models::TalkerAtsPlan& each) {
          return r_.plan.streams[each.stream.value].talker.value == device_.node;
        }))
      exported_.lose(device_.name, "ATS schedulers of what the host itself sends");
    return root;
  }

 private:
  void lose(const DevicePort& port, std::string what) {
    exported_.lose(device_.name + " to " + port.peer_name, std::move(what));
  }
  bool is_2018() const { return dialect_ == Dialect::of_2018; }

  void write_port(Data& interface, const DevicePort& port) {
    interface.set("name", port.interface);
    interface.set("type", std::string(ianaift_m) + ":ethernetCsmacd");
    const models::PortConfig& config = *port.config;
    Data& bridge_port = interface.make("bridge-port");
    write_classes(bridge_port.make("traffic-class"), config);
    write_algorithms(bridge_port, port);
    if (config.preemption) write_preemption(interface, bridge_port, port);
    if (is_2018())
      write_gates_2018(interface, port);
    else
      write_gates(bridge_port, port);
    if (config.cut_through != 0) lose(port, "cut-through: no published module has it");
    if (config.untagged)
      lose(port, "frames that leave without tag: that is membership of VLANs, which takt does not have");
    for (TrafficClass q = 0; q < models::traffic_class_count; ++q)
      if (config.queue_limits[q].is_finite() || config.queue_limits[q].drops_oldest) lose(port, "limits of queues");
  }

  void write_classes(Data& tables, const models::PortConfig& config) const {
    if (!is_2018()) tables.make("traffic-class-table").set("number-of-traffic-classes", "8");
    for (std::size_t p = 0; p < 8; ++p) {
      const std::string q = std::to_string(config.traffic_class_of_priority[p]);
      if (!is_2018()) {
        tables.make("traffic-class-table").set("priority" + std::to_string(p), q);
        continue;
      }
      Data& entry = tables.add("traffic-class-map");
      entry.set("priority", std::to_string(p));
      Data& available = entry.add("available-traffic-class");
      available.set("num-traffic-class", "8");
      available.set("traffic-class", q);
    }
  }

  void write_algorithms(Data& bridge_port, const DevicePort& port) {
    const models::ShapingConfig& shaping = port.config->shaping;
    for (TrafficClass q = 0; q < models::traffic_class_count; ++q) {
      const models::CreditBased* const shaper = shaping.shaper_of(q);
      const bool is_timed = std::holds_alternative<models::TimeBased>(shaping.selection[q]);
      if (shaping.is_shared(q)) lose(port, "the share of class " + std::to_string(q) + " (ETS)");
      if (is_timed && device_.kind == models::NodeKind::host) continue;  // launch times are not the switch's business
      if (shaper == nullptr && !is_timed) continue;
      if (is_2018()) {
        lose(port,
             "the transmission selection algorithm of class " + std::to_string(q) + ": the modules of 2018 have none");
        continue;
      }
      Data& entry =
          bridge_port.make("transmission-selection-algorithm-table").add("transmission-selection-algorithm-map");
      entry.set("traffic-class", std::to_string(q));
      entry.set("transmission-selection-algorithm",
                std::string(types_m) + (shaper != nullptr ? ":credit-based-shaper" : ":asynchronous-traffic-shaping"));
      if (shaper == nullptr) continue;
      Data& slope = bridge_port.make("cbsa").add("cbsa-parameter-table");
      slope.set("traffic-class", std::to_string(q));
      slope.set("admin-idle-slope", std::to_string(slope_of(port, q, *shaper)));
    }
  }

  /// The bandwidth of the whole cycle, as 802.1Q means it.
  std::uint64_t slope_of(const DevicePort& port, TrafficClass q, const models::CreditBased& shaper) {
    const models::ShapingConfig& shaping = port.config->shaping;
    if (shaper.of_whole_cycle || !shaping.gates || shaping.gates->admin_control_list.empty())
      return shaper.idle_slope.bits_per_second;
    const models::OpenShare share =
        models::GateControlList(shaping.gates->admin_control_list, shaping.gates->admin_cycle_time).open_share(q);
    const sim::int128 scaled = static_cast<sim::int128>(shaper.idle_slope.bits_per_second) * share.open.ps();
    if (scaled % share.cycle.ps() != 0)
      lose(port, "the idle slope of class " + std::to_string(q) +
                     " while its gate is open: over the cycle it is no whole number of bit/s");
    return static_cast<std::uint64_t>(scaled / share.cycle.ps());
  }

  void write_preemption(Data& interface, Data& bridge_port, const DevicePort& port) {
    const models::PreemptionConfig& preemption = *port.config->preemption;
    if (preemption.hold_advance) lose(port, "hold_advance, which the device has by itself");
    if (preemption.release_advance > Duration()) lose(port, "release_advance, which the device has by itself");
    if (is_2018()) {
      Data& parameters = interface.make("frame-preemption-parameters");
      for (TrafficClass q = 0; q < models::traffic_class_count; ++q) {
        Data& entry = parameters.add("frame-preemption-status-table");
        entry.set("traffic-class", std::to_string(q));
        entry.set("frame-preemption-status", models::contains(preemption.preemptable, q) ? "preemptable" : "express");
      }
      if (preemption.add_frag_size.value() != 0) lose(port, "the size of fragments: no module of 2018 has it");
      return;
    }
    Data& table = bridge_port.make("frame-preemption-parameters").make("frame-preemption-status-table");
    for (std::size_t p = 0; p < 8; ++p)
      table.set("priority" + std::to_string(p),
                models::contains(preemption.preemptable, port.config->traffic_class_of_priority[p]) ? "preemptable"
                                                                                                    : "express");
    interface.make("ethernet")
        .make("mac-merge")
        .make("admin-control")
        .set("frag-size", std::to_string(preemption.add_frag_size.value()));
  }

  std::uint64_t whole_ns(const DevicePort& port, Duration duration, const char* what) {
    if (duration.ps() % 1000 != 0)
      lose(port, std::string(what) + " that is no whole number of ns (" + json::to_text(duration) + ")");
    return static_cast<std::uint64_t>(duration.ps() / 1000);
  }

  /// ns over 10^9 in lowest terms, below 2^32.
  void set_rational(const DevicePort& port, Data& rational, Duration duration, const char* what) {
    std::uint64_t numerator = whole_ns(port, duration, what), denominator = 1'000'000'000;
    const std::uint64_t common = std::gcd(numerator, denominator);
    numerator /= common;
    denominator /= common;
    if (numerator > 0xFFFF'FFFF)
      lose(port, std::string(what) + " of " + json::to_text(duration) + ", whose fraction of a second does not fit");
    rational.set("numerator", std::to_string(std::min<std::uint64_t>(numerator, 0xFFFF'FFFF)));
    rational.set("denominator", std::to_string(denominator));
  }

  const PortLimits* limits_at(const DevicePort& port) const {
    if (limits_ == nullptr) return nullptr;
    const auto found = limits_->find(port.interface);
    return found == limits_->end() ? nullptr : &found->second;
  }

  /// What the device announces is kept; what it cannot is told.
  void check_limits(const DevicePort& port, const DeviceGates& gates) {
    const PortLimits* const limits = limits_at(port);
    if (limits == nullptr) return;
    if (limits->entries && gates.entries.size() > *limits->entries)
      lose(port, std::to_string(gates.entries.size()) + " entries in a gate list, of which the device takes " +
                     std::to_string(*limits->entries));
    if (limits->longest_cycle && gates.cycle > *limits->longest_cycle)
      lose(port, "a cycle of " + json::to_text(gates.cycle) + ", longer than the device takes (" +
                     json::to_text(*limits->longest_cycle) + ")");
    const auto shortest = limits->shortest.find(port.rate.bits_per_second / 1'000'000);
    if (shortest != limits->shortest.end() && shortest->second.cycle && gates.cycle < *shortest->second.cycle)
      lose(port, "a cycle of " + json::to_text(gates.cycle) + ", shorter than the device takes (" +
                     json::to_text(*shortest->second.cycle) + ")");
    for (const models::GateControlEntry& entry : gates.entries) {
      const auto interval = static_cast<std::uint64_t>(entry.interval.ps() / 1000);
      if (limits->longest_interval_ns && interval > *limits->longest_interval_ns)
        lose(port, "an entry of " + json::to_text(entry.interval) + ", longer than the device takes");
      if (shortest != limits->shortest.end() && shortest->second.interval_ns &&
          interval < *shortest->second.interval_ns)
        lose(port, "an entry of " + json::to_text(entry.interval) + ", shorter than the device takes (" +
                       std::to_string(*shortest->second.interval_ns) + " ns)");
      if (limits->tick_tenths_of_ns && *limits->tick_tenths_of_ns > 0 &&
          entry.interval.ps() % (static_cast<std::int64_t>(*limits->tick_tenths_of_ns) * 100) != 0)
        lose(port,
             "an entry of " + json::to_text(entry.interval) + ", which is no multiple of the device's granularity (" +
                 json::to_text(Duration::from_ps(static_cast<std::int64_t>(*limits->tick_tenths_of_ns) * 100)) + ")");
    }
  }

  /// The list as the models have it: entries of at most 2^32 - 1 ns.
  DeviceGates gates_of(const DevicePort& port) {
    DeviceGates gates = device_gates(*port.config->shaping.gates);
    constexpr Duration longest = Duration::from_ps(4'294'967'295'000);
    std::vector<models::GateControlEntry> split;
    for (models::GateControlEntry entry : gates.entries) {
      while (entry.interval > longest) {
        models::GateControlEntry part = entry;
        part.interval = longest;
        split.push_back(part);
        entry.interval -= longest;
      }
      split.push_back(entry);
    }
    gates.entries = std::move(split);
    if (gates.extension > longest)
      lose(port, "an extension of " + json::to_text(gates.extension) + ", more than 32 bits of ns");
    check_limits(port, gates);
    return gates;
  }

  static std::string operation(const models::GateControlEntry& entry) {
    constexpr std::string_view names[] = {":set-gate-states", ":set-and-hold-mac", ":set-and-release-mac"};
    return std::string(sched_m) + std::string(names[static_cast<std::size_t>(entry.operation)]);
  }

  void write_gates(Data& bridge_port, const DevicePort& port) {
    const models::ShapingConfig& shaping = port.config->shaping;
    Data& table = bridge_port.make("gate-parameter-table");
    for (TrafficClass q = 0; q < models::traffic_class_count; ++q) {
      if (shaping.queue_max_sdu[q].count == 0) continue;
      Data& entry = table.add("queue-max-sdu-table");
      entry.set("traffic-class", std::to_string(q));
      entry.set("queue-max-sdu", std::to_string(shaping.queue_max_sdu[q].count));
    }
    const PortLimits* const limits = limits_at(port);
    std::uint64_t entries = 1, longest = 999'999'999;
    Duration cycle = Duration::from_ps(1'000'000'000'000);
    if (shaping.gates && !shaping.gates->admin_control_list.empty()) {
      const DeviceGates gates = gates_of(port);
      table.set("gate-enabled", "true");
      table.set("admin-gate-states", "255");
      Data& list = table.make("admin-control-list");
      std::size_t index = 0;
      for (const models::GateControlEntry& entry : gates.entries) {
        Data& made = list.add("gate-control-entry");
        made.set("index", std::to_string(index++));
        made.set("operation-name", operation(entry));
        const std::uint64_t interval = whole_ns(port, entry.interval, "an entry");
        made.set("time-interval-value", std::to_string(interval));
        made.set("gate-states-value", std::to_string(entry.gate_states));
        longest = std::max(longest, interval);
      }
      entries = gates.entries.size();
      cycle = std::max(cycle, gates.cycle);
      set_rational(port, table.make("admin-cycle-time"), gates.cycle, "a cycle");
      table.set("admin-cycle-time-extension", std::to_string(whole_ns(port, gates.extension, "an extension")));
      const std::uint64_t base = start_ + whole_ns(port, gates.base, "a base time");
      Data& base_time = table.make("admin-base-time");
      base_time.set("seconds", std::to_string(base / 1'000'000'000));
      base_time.set("nanoseconds", std::to_string(base % 1'000'000'000));
      table.set("config-change", "true");
    } else {
      Data& none = table.make("admin-cycle-time");
      none.set("numerator", "0");
      none.set("denominator", "1");
    }
    // Without limits the published modules refuse every interface: a "must" compares with them.
    table.set("supported-list-max", std::to_string(limits != nullptr && limits->entries ? *limits->entries : entries));
    const Duration longest_cycle =
        limits != nullptr && limits->longest_cycle
            ? *limits->longest_cycle
            : Duration::from_ps((cycle.ps() + 999'999'999'999) / 1'000'000'000'000 * 1'000'000'000'000);
    set_rational(port, table.make("supported-cycle-max"), longest_cycle, "a longest cycle");
    table.set(
        "supported-interval-max",
        std::to_string(limits != nullptr && limits->longest_interval_ns ? *limits->longest_interval_ns : longest));
  }

  void write_gates_2018(Data& interface, const DevicePort& port) {
    const models::ShapingConfig& shaping = port.config->shaping;
    for (TrafficClass q = 0; q < models::traffic_class_count; ++q) {
      if (shaping.queue_max_sdu[q].count == 0) continue;
      Data& entry = interface.add("max-sdu-table");
      entry.set("traffic-class", std::to_string(q));
      entry.set("queue-max-sdu", std::to_string(shaping.queue_max_sdu[q].count));
    }
    if (!shaping.gates || shaping.gates->admin_control_list.empty()) return;
    const DeviceGates gates = gates_of(port);
    Data& table = interface.make("gate-parameters");
    table.set("gate-enabled", "true");
    table.set("admin-gate-states", "255");
    table.set("admin-control-list-length", std::to_string(gates.entries.size()));
    std::size_t index = 0;
    for (const models::GateControlEntry& entry : gates.entries) {
      constexpr std::string_view containers[] = {"sgs-params", "shm-params", "srm-params"};
      Data& made = table.add("admin-control-list");
      made.set("index", std::to_string(index++));
      made.set("operation-name", operation(entry));
      Data& parameters = made.make(containers[static_cast<std::size_t>(entry.operation)]);
      parameters.set("gate-states-value", std::to_string(entry.gate_states));
      parameters.set("time-interval-value", std::to_string(whole_ns(port, entry.interval, "an entry")));
    }
    set_rational(port, table.make("admin-cycle-time"), gates.cycle, "a cycle");
    table.set("admin-cycle-time-extension", std::to_string(whole_ns(port, gates.extension, "an extension")));
    const std::uint64_t base = start_ + whole_ns(port, gates.base, "a base time");
    Data& base_time = table.make("admin-base-time");
    base_time.set("seconds", std::to_string(base / 1'000'000'000));
    base_time.set("fractional-seconds", std::to_string(base % 1'000'000'000));
    table.set("config-change", "true");
  }

  const scenario::Resolved& r_;
  const Device& device_;
  Exported& exported_;
  Dialect dialect_;
  std::uint64_t start_;
  const std::map<std::string, PortLimits>* limits_ = nullptr;
};

/// Reads the files of a comma-separated list: what devices announce. A mistake is a text.
Limits read_limits(const std::string& files, std::string& mistake) {
  Limits limits;
  std::string_view rest = files;
  while (!rest.empty() && mistake.empty()) {
    const std::size_t comma = rest.find(',');
    InputFile file;
    file.name = std::string(rest.substr(0, comma));
    rest.remove_prefix(comma == std::string_view::npos ? rest.size() : comma + 1);
    const std::string base = std::filesystem::path(file.name).filename().string();
    file.device = device_of_file(base);
    std::ifstream stream(file.name, std::ios::binary);
    if (!stream) {
      mistake = "setting limits: " + file.name + " cannot be read";
      return limits;
    }
    file.text.assign(std::istreambuf_iterator<char>(stream), {});
    Imported imported;
    json::Diagnostics diagnostics;
    DataReader reader(imported, diagnostics);
    const auto dialect = reader.dialect_of(file);
    const auto data = dialect ? reader.read(file, *dialect) : std::nullopt;
    if (!data || diagnostics.has_errors()) {
      mistake = "setting limits:\n" + diagnostics.to_text();
      return limits;
    }
    const Data* const interfaces = data->find("interfaces");
    for (const Data& interface : interfaces == nullptr ? std::vector<Data>() : interfaces->children) {
      const Data* const port = interface.find("bridge-port");
      const Data* const gates = port != nullptr && port->find("gate-parameter-table") != nullptr
                                    ? port->find("gate-parameter-table")
                                    : interface.find("gate-parameters");
      if (gates != nullptr) limits[file.device][interface.value("name").value_or("")] = limits_of(*gates);
    }
  }
  return limits;
}

constexpr SettingInfo yang_export_table[] = {
    {"dialect", "published|2018", "published",
     "the modules: 802.1Qcw-2023 and its relatives, or the drafts of 2018 that most devices speak"},
    {"encoding", "json|xml", "json", "of the files"},
    {"start", "a whole number of ns", "0", "is added to each base time: when the run begins, since the PTP epoch"},
    {"limits", "files, with commas between", "",
     "instance data in which devices announce what they can (NODE.json, NODE.xml): longer lists, longer or shorter "
     "cycles and entries, another granularity are told; the limits stand in what is written"},
};

}  // namespace
}  // namespace yang

const std::span<const SettingInfo> yang_export_settings = yang::yang_export_table;

Exported export_yang(const ExportRequest& request) {
  Exported exported;
  if (!request.settings.number("start", 9'000'000'000'000'000'000ULL))
    exported.mistake =
        "setting start: found " + json::quote(request.settings["start"]) + ", expected a whole number of ns";
  const yang::Limits limits = yang::read_limits(request.settings["limits"], exported.mistake);
  if (!exported.mistake.empty()) return exported;
  for (const scenario::ScriptEntry& entry : request.resolved.scenario.script)
    if (entry.set_gates) exported.lose("script", "gate lists that are set during the run");
  const bool is_xml = request.settings["encoding"] == "xml";
  for (const Device& device : devices_of(request.resolved, request.interfaces)) {
    if (!request.concerns(device.node)) continue;
    const yang::Data data = yang::NodeWriter(request, device, limits, exported).write();
    exported.files.push_back(
        {device.name + (is_xml ? ".xml" : ".json"), is_xml ? yang::to_xml(data) : yang::to_json(data)});
  }
  exported.files.push_back({std::string(names_file), names_table(request.resolved, request.interfaces)});
  return exported;
}

}  // namespace takt::interchange
