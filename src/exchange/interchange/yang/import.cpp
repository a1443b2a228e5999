// SPDX-License-Identifier: Apache-2.0
// From instance data to what ports and ingress of a node are set to.
#include <algorithm>
#include <set>

#include "interchange/class_map.hpp"
#include "interchange/device_import.hpp"
#include "interchange/gate_times.hpp"
#include "interchange/yang/device_type.hpp"
#include "interchange/yang/gptp.hpp"
#include "interchange/yang/limits.hpp"
#include "interchange/yang/modules.hpp"
#include "interchange/yang/policing_import.hpp"
#include "interchange/yang/redundancy_import.hpp"
#include "interchange/yang/yang.hpp"
#include "json/quantity.hpp"

namespace takt::interchange {
namespace yang {
namespace {

using sim::Duration;

constexpr std::int64_t ns = 1000;

class PortReader {
 public:
  PortReader(Imported& imported, json::Diagnostics& diagnostics) : imported_(imported), diagnostics_(diagnostics) {}

  ImportedPort read(const Data& interface) {
    port_ = {};
    port_.interface = interface.value("name").value_or("");
    port_.place = interface.place;
    map_ = {};
    for (std::size_t q = 0; q < 8; ++q) map_.of_device[q] = models::only(static_cast<models::TrafficClass>(q));
    map_priority_.reset();
    if (const auto speed = interface.number("speed"); speed && *speed > 0) port_.rate = sim::DataRate{*speed};
    const Data* const bridge_port = interface.find(dot1q_m, "bridge-port");
    if (bridge_port != nullptr) {
      read_classes(*bridge_port);
      read_algorithms(*bridge_port);
      if (const Data* const preemption = bridge_port->find(preempt_bridge_m, "frame-preemption-parameters"))
        read_preemption(*preemption);
      if (const Data* const gates = bridge_port->find(sched_bridge_m, "gate-parameter-table"))
        read_gates(*gates, Dialect::published);
    }
    for (const Data& child : interface.children)
      if (child.schema->name == "max-sdu-table") read_max_sdu(child);
    if (const Data* const preemption = interface.find(preempt_m, "frame-preemption-parameters"))
      read_preemption(*preemption);
    if (const Data* const gates = interface.find(sched_m, "gate-parameters")) read_gates(*gates, Dialect::of_2018);
    if (const Data* const ethernet = interface.find(eth_m, "ethernet")) read_fragments(*ethernet);
    return std::move(port_);
  }

 private:
  void error(const json::Place& place, std::string message, std::string found, std::string expected) {
    diagnostics_.error(place, std::move(message), {std::move(found), std::move(expected)});
  }
  void remark(RemarkKind kind, const json::Place& place, std::string text) {
    imported_.remark(kind, place, port_.interface + ": " + std::move(text));
  }

  void read_classes(const Data& bridge_port) {
    const Data* const tables = bridge_port.find("traffic-class");
    if (tables == nullptr) return;
    std::array<std::uint8_t, 8> classes = {1, 0, 2, 3, 4, 5, 6, 7};
    bool says_any = false;
    for (const Data& entry : tables->children) {  // 2018: for each priority its class, by how many there are
      if (entry.schema->name != "traffic-class-map") continue;
      for (const Data& available : entry.children)
        if (available.schema->type == Type::list && available.number("num-traffic-class") == std::uint64_t{8}) {
          classes[entry.number("priority").value_or(0)] =
              static_cast<std::uint8_t>(available.number("traffic-class").value_or(0));
          says_any = true;
        }
    }
    const Data* const table = tables->find("traffic-class-table");
    if (table == nullptr) {
      if (says_any) parse_classes(classes, 8, *tables);
      return;
    }
    const std::uint64_t count = table->number("number-of-traffic-classes").value_or(8);
    for (std::size_t p = 0; p < 8; ++p) {
      const auto found = table->number("priority" + std::to_string(p));
      if (!found) continue;
      says_any = true;
      classes[p] = static_cast<std::uint8_t>(*found);
      if (*found >= count)
        error(table->find("priority" + std::to_string(p))->place, "a class that is not there",
              "class " + std::to_string(*found) + " for priority " + std::to_string(p),
              "a class from 0 to " + std::to_string(count - 1));
    }
    if (says_any) parse_classes(classes, count, *table);
  }

  void parse_classes(const std::array<std::uint8_t, 8>& classes, std::uint64_t count, const Data& table) {
    map_ = class_map_of(classes);
    map_priority_ = classes;
    if (map_.fit == ClassMap::Fit::split)
      remark(RemarkKind::lost, table.place,
             std::to_string(count) +
                 " classes, of which each with several priorities becomes several queues, served in strict priority");
    if (map_.fit == ClassMap::Fit::not_in_order)
      remark(RemarkKind::lost, table.place,
             "the map from priorities to classes: a higher priority lies in a lower class, and takt has no such order "
             "of service");
    else
      port_.classes = map_.classes;
  }

  std::optional<models::TrafficClass> single_class(std::uint64_t device_class, const json::Place& place,
                                                   const char* what) {
    const auto classes = list_of(map_.of_device[device_class & 15]);
    if (classes.size() == 1) return classes.front();
    if (classes.empty())
      remark(RemarkKind::ignored, place,
             std::string(what) + " of class " + std::to_string(device_class) + ", which no priority has");
    else
      error(place, std::string(what) + " of several queues",
            "class " + std::to_string(device_class) + " with " + std::to_string(classes.size()) +
                " priorities, which are queues of their own in takt",
            "a class with one priority");
    return std::nullopt;
  }

  void read_algorithms(const Data& bridge_port) {
    std::map<std::uint64_t, std::pair<std::string, json::Place>> algorithms;
    if (const Data* const table = bridge_port.find("transmission-selection-algorithm-table"))
      for (const Data& entry : table->children)
        algorithms[entry.number("traffic-class").value_or(0)] = {
            entry.value("transmission-selection-algorithm").value_or(""), entry.place};
    std::map<std::uint64_t, const Data*> slopes;
    if (const Data* const table = bridge_port.find("cbsa"))
      for (const Data& entry : table->children) slopes[entry.number("traffic-class").value_or(0)] = &entry;
    for (const auto& [number, algorithm] : algorithms) {
      const auto& [name, place] = algorithm;
      if (name.ends_with(":credit-based-shaper")) {
        const auto slope = slopes.contains(number) ? slopes[number]->number("admin-idle-slope") : std::nullopt;
        if (!slope || *slope == 0) {
          error(place, "a credit-based shaper without a slope",
                "no admin-idle-slope for class " + std::to_string(number), "cbsa-parameter-table with one");
          continue;
        }
        if (*slope > 100'000'000'000) {
          error(slopes[number]->place, "a slope that takt does not have", std::to_string(*slope) + " bit/s",
                "at most 100 Gb/s");
          continue;
        }
        if (const auto q = single_class(number, place, "a credit-based shaper"))
          port_.egress.shapers.push_back({{}, *q, sim::DataRate{*slope}, scenario::SlopeOf::cycle});
      } else if (name.ends_with(":asynchronous-traffic-shaping")) {
        if (const auto q = single_class(number, place, "ATS")) port_.egress.ats.push_back(*q);
      } else if (name.ends_with(":enhanced-transmission-selection")) {
        error(place, "an algorithm whose shares are not said",
              "enhanced-transmission-selection of class " + std::to_string(number),
              "strict-priority, credit-based-shaper or asynchronous-traffic-shaping");
      }
    }
    for (const auto& [number, slope] : slopes)
      if (!algorithms.contains(number) || !algorithms[number].first.ends_with(":credit-based-shaper"))
        remark(RemarkKind::ignored, slope->place,
               "a slope of class " + std::to_string(number) +
                   " without the algorithm credit-based-shaper, which does nothing");
  }

  void read_preemption(const Data& parameters) {
    scenario::Preemption preemption;
    models::ClassSet preemptable = 0;
    if (parameters.schema->module == preempt_m) {
      for (const Data& entry : parameters.children)
        if (entry.value("frame-preemption-status") == "preemptable")
          preemptable =
              static_cast<models::ClassSet>(preemptable | map_.of_device[entry.number("traffic-class").value_or(0)]);
    } else if (const Data* const table = parameters.find("frame-preemption-status-table")) {
      // By priority: all of a class must agree.
      const auto& takt = map_.classes == scenario::TrafficClasses::identity ? models::identity_traffic_classes
                                                                            : models::standard_traffic_classes;
      std::array<bool, 8> is_preemptable{};
      for (std::size_t p = 0; p < 8; ++p)
        is_preemptable[p] = table->value("priority" + std::to_string(p)) == "preemptable";
      for (std::size_t p = 0; p < 8; ++p) {
        if (is_preemptable[p]) preemptable = models::with(preemptable, takt[p]);
        for (std::size_t other = 0; other < p && map_priority_; ++other)
          if ((*map_priority_)[p] == (*map_priority_)[other] && is_preemptable[p] != is_preemptable[other])
            error(table->place, "one class with express and preemptable priorities",
                  "priorities " + std::to_string(other) + " and " + std::to_string(p) + " of class " +
                      std::to_string((*map_priority_)[p]),
                  "the same status for all priorities of a class");
      }
    }
    if (preemptable == 0) return;
    preemption.preemptable = list_of(preemptable);
    if (const auto advance = parameters.number("hold-advance"))
      preemption.hold_advance = Duration::from_ps(static_cast<std::int64_t>(*advance) * ns);
    if (const auto advance = parameters.number("release-advance"))
      preemption.release_advance = Duration::from_ps(static_cast<std::int64_t>(*advance) * ns);
    port_.egress.preemption = std::move(preemption);
  }

  void read_fragments(const Data& ethernet) {
    const Data* const merge = ethernet.find("mac-merge");
    const Data* const control = merge == nullptr ? nullptr : merge->find("admin-control");
    if (control == nullptr) return;
    if (port_.egress.preemption)
      port_.egress.preemption->add_frag_size = static_cast<std::uint8_t>(control->number("frag-size").value_or(0));
    if (control->value("verify-disable-tx") == "disabled")
      remark(RemarkKind::ignored, control->place, "verification of the other side, which always succeeds in takt");
    if (control->value("merge-enable-tx") == "disabled" && port_.egress.preemption)
      remark(RemarkKind::lost, control->place, "merge-enable-tx disabled beside preemptable priorities");
  }

  void read_max_sdu(const Data& entry) {
    const std::uint64_t size = entry.number("queue-max-sdu").value_or(0);
    if (size == 0) return;
    if (size > 1500)
      return remark(RemarkKind::ignored, entry.place,
                    "a largest SDU of " + std::to_string(size) + " octets: takt's frames have at most 1500");
    for (const std::uint8_t q : list_of(map_.of_device[entry.number("traffic-class").value_or(0)]))
      port_.egress.max_sdu.push_back({{}, q, sim::Octets{static_cast<std::uint32_t>(size)}});
  }

  void read_gates(const Data& table, Dialect dialect) {
    for (const Data& child : table.children)
      if (child.schema->name == "queue-max-sdu-table") read_max_sdu(child);
    const PortLimits limits = limits_of(table);
    const std::vector<const Data*> entries = sorted_entries(table, dialect);
    check_limits(table, limits, entries);
    if (!table.is_true("gate-enabled")) {
      if (!entries.empty()) remark(RemarkKind::ignored, table.place, "a gate list that is not enabled");
      if (limits.says_something() && entries.empty())
        remark(RemarkKind::ignored, table.place,
               "limits of the device: give this file to the export (takt export yang -o limits=FILE)");
      return;
    }
    if (entries.empty()) {
      const std::uint64_t states = table.number("admin-gate-states").value_or(255);
      if (map_.takt_classes(states) == models::every_class)
        return remark(RemarkKind::odd, table.place, "gates without a list, all of them open for ever");
      scenario::Gates gates;
      gates.entries.push_back(
          {{}, list_of(map_.takt_classes(states)), Duration::from_ps(1'000'000'000), scenario::MacOperation::none});
      port_.egress.gates = std::move(gates);
      return remark(RemarkKind::changed, table.place, "gates without a list: one entry of 1 ms with their states");
    }
    if (!table.is_true("config-change"))
      remark(RemarkKind::odd, table.place,
             "config-change is not set, so the list would not begin; it is taken as if it were");
    if (const auto length = table.number("admin-control-list-length"); length && *length != entries.size())
      remark(RemarkKind::odd, table.find("admin-control-list-length")->place,
             "a length of " + std::to_string(*length) + " for " + std::to_string(entries.size()) +
                 " entries, which count");
    const std::vector<const Data*> written = entries_of(table, dialect);
    if (written != entries)
      remark(RemarkKind::odd, table.place, "entries that are not in the order of their index, by which they count");
    read_list(table, entries, dialect);
  }

  static std::vector<const Data*> entries_of(const Data& table, Dialect dialect) {
    std::vector<const Data*> entries;
    if (dialect == Dialect::published) {
      if (const Data* const list = table.find("admin-control-list"))
        for (const Data& entry : list->children) entries.push_back(&entry);
    } else {
      for (const Data& child : table.children)
        if (child.schema->name == "admin-control-list") entries.push_back(&child);
    }
    return entries;
  }
  static std::vector<const Data*> sorted_entries(const Data& table, Dialect dialect) {
    std::vector<const Data*> entries = entries_of(table, dialect);
    std::ranges::stable_sort(entries, {}, [](const Data* entry) { return entry->number("index").value_or(0); });
    return entries;
  }

  void check_limits(const Data& table, const PortLimits& limits, const std::vector<const Data*>& entries) {
    if (limits.entries && entries.size() > *limits.entries)
      error(table.place, "a gate list that is longer than the device takes",
            std::to_string(entries.size()) + " entries",
            "at most supported-list-max, " + std::to_string(*limits.entries));
    const Data* const cycle = table.find("admin-cycle-time");
    const auto length = cycle == nullptr ? std::nullopt : seconds_of(*cycle);
    if (length && limits.longest_cycle && *length > *limits.longest_cycle)
      error(cycle->place, "a cycle that is longer than the device takes", json::to_text(*length),
            "at most supported-cycle-max, " + json::to_text(*limits.longest_cycle));
    for (const Data* const entry : entries)
      if (const auto interval = entry->number("time-interval-value");
          interval && limits.longest_interval_ns && *interval > *limits.longest_interval_ns)
        error(entry->place, "an interval that is longer than the device takes", std::to_string(*interval) + " ns",
              "at most supported-interval-max, " + std::to_string(*limits.longest_interval_ns));
  }

  /// The container of an entry's parameters, in the dialect of 2018 by operation.
  const Data* parameters_of(const Data& entry, const std::string& operation, Dialect dialect) {
    if (dialect == Dialect::published) return &entry;
    const std::string_view wanted = operation.ends_with(":set-and-hold-mac")      ? "shm-params"
                                    : operation.ends_with(":set-and-release-mac") ? "srm-params"
                                                                                  : "sgs-params";
    for (const Data& child : entry.children)
      if (child.schema->type == Type::container && child.schema->name != wanted) {
        error(child.place, "parameters of another operation", std::string(child.schema->name) + " beside " + operation,
              std::string(wanted));
        return nullptr;
      }
    return entry.find(wanted);
  }

  void read_list(const Data& table, const std::vector<const Data*>& entries, Dialect dialect) {
    scenario::Gates gates;
    Duration sum;
    std::uint64_t opened = 0;
    for (const Data* const entry : entries) {
      const std::string operation = entry->value("operation-name").value_or("");
      const std::size_t before = diagnostics_.errors();
      const Data* const parameters = parameters_of(*entry, operation, dialect);
      if (diagnostics_.errors() != before) continue;
      const auto interval = parameters == nullptr ? std::nullopt : parameters->number("time-interval-value");
      const auto states = parameters == nullptr ? std::nullopt : parameters->number("gate-states-value");
      if (!interval || *interval == 0) {
        error(entry->place, "an entry without an interval", interval ? "0 ns" : "no time-interval-value",
              "ns, at least 1");
        continue;
      }
      if (!states) {
        error(entry->place, "an entry without states", "no gate-states-value", "a mask of open gates");
        continue;
      }
      scenario::GateEntry made;
      made.open = list_of(map_.takt_classes(*states));
      made.interval = Duration::from_ps(static_cast<std::int64_t>(*interval) * ns);
      made.mac = operation.ends_with(":set-and-hold-mac")      ? scenario::MacOperation::hold
                 : operation.ends_with(":set-and-release-mac") ? scenario::MacOperation::release
                                                               : scenario::MacOperation::none;
      sum += made.interval;
      opened |= *states;
      gates.entries.push_back(std::move(made));
    }
    const bool has_masks_of_others = map_priority_ && map_.fit != ClassMap::Fit::exact &&
                                     (opened >> (*std::ranges::max_element(*map_priority_) + 1)) != 0;
    if (has_masks_of_others) remark(RemarkKind::odd, table.place, "masks with classes that no priority has");
    read_times(table, sum, gates);
    models::ClassSet never = models::every_class;
    for (const scenario::GateEntry& entry : gates.entries)
      for (const std::uint8_t q : entry.open) never = models::without(never, q);
    if (never != 0) {
      std::string names;
      for (const std::uint8_t q : list_of(never)) names += " " + std::to_string(q);
      remark(RemarkKind::odd, table.place, "a gate list that never opens class" + names);
    }
    port_.egress.gates = std::move(gates);
  }

  void read_times(const Data& table, Duration sum, scenario::Gates& gates) {
    const Data* const cycle = table.find("admin-cycle-time");
    std::optional<Duration> length;
    if (cycle != nullptr && cycle->number("numerator").value_or(0) != 0) {
      length = seconds_of(*cycle);
      const std::string fraction =
          cycle->value("numerator").value_or("0") + "/" + cycle->value("denominator").value_or("0") + " s";
      if (!length || length->ps() % ns != 0) {
        error(cycle->place, "a cycle that is no whole number of ns", fraction, "a fraction of a second that is one");
        return;
      }
      if (*length > Duration::from_ps(3'600'000'000'000'000)) {
        error(cycle->place, "a cycle that takt does not have", fraction, "at most an hour");
        return;
      }
    } else {
      remark(RemarkKind::odd, table.place, "no cycle: the sum of the entries, " + json::to_text(sum));
    }
    if (length && *length < sum)
      remark(RemarkKind::odd, cycle->place,
             "entries of " + json::to_text(sum) + " in a cycle of " + json::to_text(*length) + ": the end is cut off");
    if (length && *length > sum)
      remark(
          RemarkKind::odd, cycle->place,
          "entries of " + json::to_text(sum) + " in a cycle of " + json::to_text(*length) + ": the last state stays");
    gates.cycle = length;
    gates.extension =
        Duration::from_ps(static_cast<std::int64_t>(table.number("admin-cycle-time-extension").value_or(0)) * ns);
    const Data* const base = table.find("admin-base-time");
    if (base == nullptr) return;
    const std::uint64_t fraction = base->number("nanoseconds").value_or(base->number("fractional-seconds").value_or(0));
    if (fraction >= 1'000'000'000) {
      error(base->place, "a fraction of a second of a second or more", std::to_string(fraction) + " ns",
            "less than 1000000000 ns");
      return;
    }
    const std::uint64_t seconds = base->number("seconds").value_or(0);
    if (seconds > 1'000'000'000'000ULL) {
      error(base->place, "a base time beyond all reason", std::to_string(seconds) + " s", "at most 10^12 s");
      return;
    }
    const FoldedTime folded = fold_base_time(
        static_cast<sim::int128>(seconds) * 1'000'000'000 + static_cast<sim::int128>(fraction), length.value_or(sum));
    if (folded.is_folded)
      remark(RemarkKind::changed, base->place,
             "a base time of a running clock, folded into the cycle: " + json::to_text(folded.base));
    gates.base_time = folded.base;
  }

  Imported& imported_;
  json::Diagnostics& diagnostics_;
  ImportedPort port_;
  ClassMap map_;
  std::optional<std::array<std::uint8_t, 8>> map_priority_;
};

}  // namespace
}  // namespace yang

Imported import_yang(const ImportRequest& request, json::Diagnostics& diagnostics) {
  Imported imported;
  Names names;
  std::vector<std::pair<const InputFile*, yang::Data>> read;
  yang::DataReader reader(imported, diagnostics);
  for (const InputFile& file : request.files) {
    if (is_names_file(file)) {
      names.read(file, diagnostics);
      continue;
    }
    const auto dialect = reader.dialect_of(file);
    if (!dialect) continue;
    if (auto data = reader.read(file, *dialect)) read.emplace_back(&file, std::move(*data));
  }
  std::vector<ImportedDevice> devices;
  for (const auto& [file, data] : read) {
    auto device = std::ranges::find(devices, file->device, &ImportedDevice::name);
    if (device == devices.end()) {
      device = devices.insert(devices.end(), ImportedDevice{});
      device->name = file->device;
      device->place = {file->name, 0, 0, ""};
      device->forwards = true;
    }
    yang::PortReader ports(imported, diagnostics);
    if (const yang::Data* const interfaces = data.find("interfaces"))
      for (const yang::Data& interface : interfaces->children) device->ports.push_back(ports.read(interface));
    yang::read_gptp(data, *device, imported, diagnostics);
    yang::read_policing(data, names, request.base != nullptr, *device, imported, diagnostics);
  }
  if (diagnostics.has_errors()) return imported;
  build_scenario(std::move(devices), request, names, imported, diagnostics);
  if (!imported.scenario) return imported;
  yang::DeviceData tables;
  for (const auto& [file, data] : read) tables.emplace_back(file->device, &data);
  yang::read_redundancy(tables, names, *imported.scenario, imported, diagnostics);
  yang::set_announced(tables, *imported.scenario, imported, diagnostics);
  if (diagnostics.has_errors()) imported.scenario.reset();
  return imported;
}

}  // namespace takt::interchange
