// SPDX-License-Identifier: Apache-2.0
#include "interchange/linux/meaning.hpp"

#include <algorithm>
#include <array>

#include "interchange/class_map.hpp"
#include "interchange/gate_times.hpp"
#include "json/quantity.hpp"

namespace takt::interchange::linux_tc {
namespace {

using sim::Duration;

constexpr std::int64_t ps_per_ns = 1000;
constexpr std::int64_t longest_ns = 3'600'000'000'000;  // of cycles and entries in takt

class Translator {
 public:
  Translator(Imported& imported, json::Diagnostics& diagnostics) : imported_(imported), diagnostics_(diagnostics) {}

  ImportedPort port_of(const std::string& name, const Interface& interface) {
    ImportedPort port;
    port.interface = name;
    port.place = interface.place;
    port.egress.untagged = interface.untagged;
    if (interface.rate) port.rate = sim::DataRate{*interface.rate};
    ClassMap map;
    if (interface.classes) {
      map = map_of(*interface.classes);
      const bool sets_something =
          !interface.classes->entries.empty() || !interface.shapers.empty() || !interface.classes->preemptable.empty();
      if (map.fit == ClassMap::Fit::not_in_order && !sets_something)
        ignore(
            interface.classes->place,
            "a map from priorities to classes in another order than takt's, with nothing that is set of its classes");
      else
        report_fit(*interface.classes, map);
      if (map.fit != ClassMap::Fit::not_in_order) port.classes = map.classes;
      if (interface.classes->kind == ClassKind::taprio) gates_of(*interface.classes, map, port);
      preemption_of(interface, map, port);
      max_sdu_of(*interface.classes, map, port);
    } else {
      preemption_of(interface, map, port);
    }
    for (const CreditShaper& shaper : interface.shapers) shaper_of(interface, shaper, map, port);
    for (const LaunchTimes& launch : interface.launches)
      ignore(launch.place, launch.deadline_mode
                               ? "etf with deadlines, which are no launch times"
                               : "etf: launch times belong to streams in takt (\"launch\"); delta has no key");
    return port;
  }

  scenario::Ingress ingress_of(const Machine& machine, const Names& names) {
    scenario::Ingress ingress;
    std::vector<std::pair<IngressFilter, std::string>> seen;
    for (const auto& [name, interface] : machine.interfaces)
      for (const IngressFilter& filter : interface.filters) add_filter(filter, name, seen, names, ingress);
    return ingress;
  }

 private:
  void lose(const json::Place& place, std::string text) { imported_.remark(RemarkKind::lost, place, std::move(text)); }
  void ignore(const json::Place& place, std::string text) {
    imported_.remark(RemarkKind::ignored, place, std::move(text));
  }
  void change(const json::Place& place, std::string text) {
    imported_.remark(RemarkKind::changed, place, std::move(text));
  }

  static ClassMap map_of(const Classes& classes) {
    std::array<std::uint8_t, 8> class_of_priority{};
    for (std::size_t p = 0; p < 8; ++p)
      if (p < classes.map.size()) class_of_priority[p] = static_cast<std::uint8_t>(classes.map[p].value & 15);
    return class_map_of(class_of_priority);
  }

  void report_fit(const Classes& classes, const ClassMap& map) {
    if (map.fit == ClassMap::Fit::split)
      lose(classes.place,
           std::to_string(classes.num_tc.value) +
               " classes, of which each with several priorities becomes several queues, served in strict priority");
    if (map.fit == ClassMap::Fit::not_in_order)
      lose(classes.place,
           "the map from priorities to classes: a higher priority lies in a lower class, and takt has no such order of "
           "service");
  }

  Duration duration(std::int64_t ns, const json::Place& place, const char* what) {
    if (ns <= longest_ns) return Duration::from_ps(ns * ps_per_ns);
    diagnostics_.error(place, std::string("too long ") + what, {std::to_string(ns) + " ns", "at most an hour"});
    return Duration::from_ps(ps_per_ns);
  }

  void gates_of(const Classes& classes, const ClassMap& map, ImportedPort& port) {
    scenario::Gates gates;
    std::int64_t sum = 0;
    for (const GateLine& line : classes.entries) {
      scenario::GateEntry entry;
      entry.open = list_of(map.takt_classes(line.mask));
      entry.interval = duration(line.interval, line.place, "an entry");
      entry.mac = line.operation == 'H'   ? scenario::MacOperation::hold
                  : line.operation == 'R' ? scenario::MacOperation::release
                                          : scenario::MacOperation::none;
      gates.entries.push_back(std::move(entry));
      sum += line.interval;
    }
    const bool in_hardware = (classes.flags.value & 2) != 0;
    const std::int64_t cycle_ns = classes.cycle_time ? classes.cycle_time->value : sum;
    const Duration cycle =
        duration(cycle_ns, classes.cycle_time ? classes.cycle_time->place : classes.place, "a cycle");
    if (cycle_ns != sum && in_hardware)
      gates.cycle = cycle;
    else if (cycle_ns != sum)
      lose(classes.cycle_time->place, "a cycle of " + json::to_text(cycle) +
                                          ": in software the list begins anew after its last entry, at " +
                                          std::to_string(sum) + " ns, and that is what takt does");
    const Duration period = gates.cycle.value_or(Duration::from_ps(sum * ps_per_ns));
    const FoldedTime base = fold_base_time(classes.base_time.value, period);
    if (base.is_folded)
      change(classes.base_time.place,
             "a base time of a running clock, folded into the cycle: " + json::to_text(base.base));
    gates.base_time = base.base;
    gates.extension = duration(classes.extension.value, classes.extension.place, "an extension");
    if ((classes.flags.value & 1) != 0)
      lose(classes.flags.place,
           "launch times instead of gates in the interface: takt has the gates; txtime-delay and delta have no key");
    else if (!in_hardware)
      lose(classes.place, "gates in software: takt's are as exact as those in hardware");
    const bool is_constant = std::ranges::all_of(classes.entries, [&](const GateLine& line) {
      return line.operation == 'S' && map.takt_classes(line.mask) == models::every_class;
    });
    if (!is_constant) port.egress.gates = std::move(gates);
  }

  void preemption_of(const Interface& interface, const ClassMap& map, ImportedPort& port) {
    const bool says_classes = interface.classes && !interface.classes->preemptable.empty();
    const std::optional<MacMerge>& merge = interface.merge;
    const bool sends = merge && merge->tx && merge->tx->value;
    if (merge && !sends) {
      ignore(merge->place, says_classes ? "preemptable classes of a port that sends no fragments"
                                        : "a port that takes fragments and sends none, as every port of takt does");
      return;
    }
    if (!merge && !says_classes) return;
    scenario::Preemption preemption;
    if (says_classes) {
      std::uint64_t preemptable = 0;
      for (std::size_t c = 0; c < interface.classes->preemptable.size(); ++c)
        if (interface.classes->preemptable[c].value) preemptable |= std::uint64_t{1} << c;
      preemption.preemptable = list_of(map.takt_classes(preemptable));
      if (preemption.preemptable.empty()) return;
      if (!merge)
        change(interface.classes->place,
               "preemptable classes without \"ethtool --set-mm\" of the port: as if tx-enabled were on");
    } else {
      preemption.preemptable = {0};
      change(merge->place,
             "preemption of a port none of whose classes is said to be preemptable (fp): class 0 is taken");
    }
    if (merge && merge->verify && merge->verify->value) {
      const std::string text = "verification of the other side, which always succeeds in takt";
      if (says_classes)
        ignore(merge->verify->place, text);
      else
        lose(merge->verify->place, text + "; nothing else of preemption is said");
    }
    if (merge && merge->fragment)
      preemption.add_frag_size = static_cast<std::uint8_t>((merge->fragment->value + 4) / 64 - 1);
    port.egress.preemption = std::move(preemption);
  }

  void max_sdu_of(const Classes& classes, const ClassMap& map, ImportedPort& port) {
    if (classes.is_dumped && !classes.max_sdu.empty()) {
      ignore(classes.place, "max-sdu as the kernel prints it: the effective sizes, also limited by the longest window");
      return;
    }
    for (std::size_t c = 0; c < classes.max_sdu.size(); ++c) {
      const std::int64_t octets = classes.max_sdu[c].value;
      if (octets == 0) continue;
      if (octets < 0)
        diagnostics_.error(classes.max_sdu[c].place, "not a size", {std::to_string(octets), "octets, or 0 for any"});
      else if (octets > 1500)
        ignore(classes.max_sdu[c].place,
               "a largest SDU of " + std::to_string(octets) + " octets: takt's frames have at most 1500");
      else
        for (const std::uint8_t q : list_of(map.of_device[c & 15]))
          port.egress.max_sdu.push_back({{}, q, sim::Octets{static_cast<std::uint32_t>(octets)}});
    }
  }

  void shaper_of(const Interface& interface, const CreditShaper& shaper, const ClassMap& map, ImportedPort& port) {
    if (!interface.classes) {
      diagnostics_.error(shaper.place, "a shaper without classes",
                         {"cbs of an interface without taprio or mqprio", "a class to shape"});
      return;
    }
    const auto device_class = class_of_parent(*interface.classes, shaper.parent);
    if (!device_class) return;  // told by check()
    const auto classes = list_of(map.of_device[*device_class & 15]);
    if (classes.size() > 1) {
      diagnostics_.error(shaper.place, "one credit for several queues",
                         {"class " + std::to_string(*device_class) + " has " + std::to_string(classes.size()) +
                              " priorities, which are queues of their own in takt",
                          "a class with one priority"});
      return;
    }
    if (classes.empty()) {
      ignore(shaper.place, "a shaper of a class without a priority");
      return;
    }
    scenario::Shaper made;
    made.traffic_class = classes.front();
    made.idle_slope = sim::DataRate{static_cast<std::uint64_t>(shaper.idleslope.value) * 1000};
    made.of = scenario::SlopeOf::window;
    const std::uint64_t rate = *port_rate_of(shaper);
    port.rate = sim::DataRate{rate};
    port.egress.shapers.push_back(made);
  }

  /// A filter of several interfaces is one of the device: takt polices alike at all ports.
  void add_filter(const IngressFilter& filter, const std::string& interface,
                  std::vector<std::pair<IngressFilter, std::string>>& seen, const Names& names,
                  scenario::Ingress& ingress) {
    const auto is_same = [&](const std::pair<IngressFilter, std::string>& other) {
      return other.second != interface && other.first.preference == filter.preference &&
             other.first.address == filter.address && other.first.vlan == filter.vlan &&
             other.first.priority == filter.priority;
    };
    if (std::ranges::any_of(seen, is_same)) return;
    seen.emplace_back(filter, interface);
    scenario::StreamFilterEntry entry;
    const std::string number = std::to_string(seen.size());
    if (filter.address) {
      const std::string name =
          names.stream(*filter.address).value_or(names.node(*filter.address).value_or("stream-" + number));
      const auto unique = std::ranges::any_of(ingress.streams,
                                              [&](const scenario::IdentifiedStream& each) { return each.name == name; })
                              ? name + "-" + number
                              : name;
      const scenario::TaggedFrames tagged = filter.vlan ? scenario::TaggedFrames::tagged : scenario::TaggedFrames::all;
      ingress.streams.push_back(identity_of(unique, *filter.address,
                                            static_cast<std::uint16_t>(filter.vlan.value_or(0)), tagged, names,
                                            filter.place, imported_));
      entry.stream = unique;
    } else if (filter.vlan) {
      lose(filter.place, "the VLAN " + std::to_string(*filter.vlan) + " of a filter without an address");
    }
    if (filter.priority) entry.pcp = static_cast<std::uint8_t>(*filter.priority);
    if (filter.gate) entry.gate = gate_of(*filter.gate, number, ingress);
    if (filter.police) {
      lose(filter.police->place,
           "which octets the meter counts differs by hook and hardware; in takt those from DA to FCS");
      const std::string name = filter.police->index != 0 ? std::to_string(filter.police->index) : "meter-" + number;
      if (std::ranges::none_of(ingress.meters, [&](const scenario::Meter& each) { return each.name == name; })) {
        scenario::Meter meter;
        meter.name = name;
        meter.cir = sim::DataRate{filter.police->rate};
        meter.cbs = sim::Octets{static_cast<std::uint32_t>(filter.police->burst)};
        ingress.meters.push_back(meter);
      }
      entry.meter = name;
    }
    ingress.filters.push_back(std::move(entry));
  }

  std::string gate_of(const GateAction& action, const std::string& number, scenario::Ingress& ingress) {
    const std::string name = action.index != 0 ? std::to_string(action.index) : "gate-" + number;
    if (std::ranges::any_of(ingress.gates,
                            [&](const scenario::StreamGateEntryList& each) { return each.name == name; }))
      return name;
    scenario::StreamGateEntryList gate;
    gate.name = name;
    if (action.priority >= 0) gate.ipv = static_cast<std::uint8_t>(action.priority);
    std::int64_t sum = 0;
    bool counts_octets = false;
    for (const StreamGateLine& line : action.entries) {
      scenario::StreamGateStep step;
      step.open = line.open;
      if (line.priority >= 0) step.ipv = static_cast<std::uint8_t>(line.priority);
      step.interval = duration(line.interval, line.place, "an entry");
      if (line.octets >= 0) step.octets = sim::Octets{static_cast<std::uint32_t>(line.octets)};
      counts_octets = counts_octets || line.octets >= 0;
      gate.entries.push_back(step);
      sum += line.interval;
    }
    if (gate.entries.size() == 1 && !counts_octets) {  // it never changes
      gate.open = gate.entries.front().open;
      gate.ipv = gate.entries.front().ipv ? gate.entries.front().ipv : gate.ipv;
      gate.entries.clear();
      ingress.gates.push_back(std::move(gate));
      return name;
    }
    if (counts_octets)
      lose(action.place,
           "which octets the gate's last number counts differs by hook and hardware; in takt those behind the "
           "EtherType");
    if (action.cycle_time && action.cycle_time->value != sum)
      gate.cycle = duration(action.cycle_time->value, action.cycle_time->place, "a cycle");
    const FoldedTime base =
        fold_base_time(action.base_time.value, gate.cycle.value_or(Duration::from_ps(sum * ps_per_ns)));
    if (base.is_folded)
      change(action.base_time.place,
             "a base time of a running clock, folded into the cycle: " + json::to_text(base.base));
    gate.base_time = base.base;
    ingress.gates.push_back(std::move(gate));
    return name;
  }

  Imported& imported_;
  json::Diagnostics& diagnostics_;
};

}  // namespace

ImportedDevice device_of(const std::string& name, const json::Place& place, const Machine& machine, const Names& names,
                         Imported& imported, json::Diagnostics& diagnostics) {
  ImportedDevice device;
  device.name = name;
  device.place = place;
  const bool polices =
      std::ranges::any_of(machine.interfaces, [](const auto& each) { return !each.second.filters.empty(); });
  device.forwards = machine.has_bridge || polices || machine.interfaces.size() > 1;
  Translator translator(imported, diagnostics);
  for (const auto& [interface, settings] : machine.interfaces)
    device.ports.push_back(translator.port_of(interface, settings));
  if (polices) device.ingress = translator.ingress_of(machine, names);
  if (machine.has_bridge)
    imported.remark(RemarkKind::lost, place,
                    "membership of ports in VLANs and filtering entries: takt forwards along the paths of streams");
  return device;
}

}  // namespace takt::interchange::linux_tc
