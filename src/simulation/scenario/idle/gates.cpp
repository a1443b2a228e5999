// SPDX-License-Identifier: Apache-2.0
// Gate lists that close for nobody, open for too short, begin after the end, hold what is not preemptable; limits of
// queues that nobody uses.
#include <algorithm>
#include <array>
#include <bit>

#include "models/ethernet/sizes.hpp"
#include "scenario/gates/beginning.hpp"
#include "scenario/idle/usage.hpp"
#include "scenario/resolve/control_list.hpp"
#include "scenario/resolve/egress.hpp"

namespace takt::scenario {
namespace {

using Ports = std::vector<const PortUse*>;

/// A gate list as it is written, and the ports that it is for.
class GatesTeller {
 public:
  GatesTeller(const Usage& usage, json::Diagnostics& diagnostics) : usage_(usage), diagnostics_(diagnostics) {}

  /// `begins` is when the list is set.
  void run(const Gates& gates, const Ports& ports, Duration begins) {
    if (ports.empty()) return;
    if (usage_.is_after_the_end(std::max(begins, gates.base_time)))
      return warn_once(diagnostics_, gates.where.at("base_time"), "gates that begin after the end of the simulation",
                       {json::to_text(std::max(begins, gates.base_time)),
                        "less than " + json::to_text(usage_.resolved().scenario.duration)});
    before_clocks(gates, ports, std::max(begins, gates.base_time));
    const bool is_changed =
        std::any_of(ports.begin(), ports.end(), [](const PortUse* port) { return port->gates.size() > 1; });
    if (gates.extension > Duration() && !is_changed)
      warn_once(diagnostics_, gates.where.at("extension"), "an extension that nothing needs",
                {"no other list for " + usage_.name(ports), "a \"set_gates\" of the script"});
    const bool is_exact = std::all_of(ports.begin(), ports.end(), [&](const PortUse* port) {
      return !usage_.resolved().plan.nodes[port->node].clock;
    });
    if (gates.running && is_exact && begins_at_the_start(gates, cycle_of(gates)))
      warn_once(
          diagnostics_, gates.where.at("running"), "a list that begins at the start in any case",
          {"\"base_time\" of " + json::to_text(gates.base_time) + " and a cycle of " + json::to_text(cycle_of(gates)),
           "a \"base_time\" in the middle of a cycle"});
    const bool is_cut = std::any_of(ports.begin(), ports.end(),
                                    [](const PortUse* port) { return port->config->preemption.has_value(); });
    for (const GateEntry& entry : gates.entries)
      if (entry.mac != MacOperation::none && !is_cut) {
        warn_once(diagnostics_, entry.where.at("mac"), "preemptable frames held that there are not",
                  {"no preemption at " + usage_.name(ports), "\"preemption\" beside \"gates\""});
        break;
      }
    closing(gates, ports);
    opening(gates, ports);
  }

 private:
  /// Clocks that are off open them at the wrong times.
  void before_clocks(const Gates& gates, const Ports& ports, Duration begin) {
    const Resolved& resolved = usage_.resolved();
    const auto from = clocks_synchronised_from(resolved.scenario);
    const auto is_led = [&](const PortUse* port) { return static_cast<bool>(resolved.plan.gptp[port->node]); };
    if (!from || resolved.plan.gptp.empty() || begin >= *from || *from >= resolved.scenario.duration ||
        std::none_of(ports.begin(), ports.end(), is_led))
      return;
    warn_once(diagnostics_, gates.where.at("base_time"), "gates that run before clocks are synchronised",
              {"lists of " + usage_.name(ports) + " from " + json::to_text(begin) + " on, and clocks from " +
                   json::to_text(*from) + " on: a frame that misses its window then stands before all that follow",
               "a \"base_time\" of " + json::to_text(*from) + " or later"});
  }

  static Duration cycle_of(const Gates& gates) {
    Duration sum;
    for (const GateEntry& entry : gates.entries) sum += entry.interval;
    return gates.cycle.value_or(sum);
  }

  void closing(const Gates& gates, const Ports& ports) {
    models::ClassSet closed = 0;
    for (const GateEntry& entry : gates.entries) {
      models::ClassSet open = 0;
      for (const std::uint8_t q : entry.open) open = models::with(open, q);
      closed = static_cast<models::ClassSet>(closed | ~open);
    }
    models::ClassSet used = 0;
    for (const PortUse* port : ports) used = static_cast<models::ClassSet>(used | port->classes);
    const bool holds = std::any_of(gates.entries.begin(), gates.entries.end(),
                                   [](const GateEntry& entry) { return entry.mac != MacOperation::none; });
    if ((closed & used) != 0 || holds) return;
    warn_once(
        diagnostics_, gates.where.place(), "gates that close for no frame",
        {used == 0 ? "no stream leaves through " + usage_.name(ports)
                   : "class " + text_of_classes(used) + " in use at " + usage_.name(ports) + ", open at all times",
         "entries that close a class in use"});
  }

  /// Classes that are asked for more than the time in which their gates are open carries: each for itself, then those
  /// that share it.
  void opening(const Gates& gates, const Ports& ports) {
    json::Diagnostics aside;  // mistakes of the list have been reported
    const models::GateConfig config = gate_config_of(gates, aside);
    if (aside.has_errors()) return;
    std::array<models::ClassSet, 256> sets{};
    for (std::size_t set = 0; set < sets.size(); ++set) sets[set] = static_cast<models::ClassSet>(set);
    std::ranges::stable_sort(sets, {}, [](models::ClassSet set) { return std::popcount(set); });
    for (const PortUse* port : ports)
      for (const models::ClassSet set : sets) {
        if (set == 0 || (set & ~port->classes) != 0) continue;
        double load = 0;
        for (models::TrafficClass q = 0; q < models::traffic_class_count; ++q)
          if (models::contains(set, q)) load += usage_.load(*port, q);
        const auto [open, carries] = open_for(config, set, *port);
        if (open.open == open.cycle || load <= carries * (1 + 1e-9)) continue;
        return warn_once(diagnostics_, gates.where.at("entries"), "gates that are open for less than is asked",
                         {json::to_text(open.open) + " of " + json::to_text(open.cycle) + ", " +
                              json::to_text(DataRate{static_cast<std::uint64_t>(carries)}) + ", for " +
                              json::to_text(DataRate{static_cast<std::uint64_t>(load)}) + " of class " +
                              text_of_classes(set) + " at " + usage_.name({port}) + ", preamble and gap included",
                          "windows that carry them"});
      }
  }
  /// For how long at least one gate of the set is open, and how much that carries: the gap behind the last frame of a
  /// window may lie outside of it.
  static std::pair<models::OpenShare, double> open_for(models::GateConfig config, models::ClassSet set,
                                                       const PortUse& port) {
    for (models::GateControlEntry& entry : config.admin_control_list)
      entry.gate_states = (entry.gate_states & set) != 0 ? models::all_gates_open : models::GateStates{0};
    const models::GateControlList list(config.admin_control_list, config.admin_cycle_time);
    const models::OpenShare open = list.open_share(0);
    const auto gaps = static_cast<double>(port.link->rate.octet_time().ps() * models::inter_packet_gap.count) *
                      static_cast<double>(list.windows(0).size());
    return {open, static_cast<double>(port.link->rate.bits_per_second) * (static_cast<double>(open.open.ps()) + gaps) /
                      static_cast<double>(open.cycle.ps())};
  }

  const Usage& usage_;
  json::Diagnostics& diagnostics_;
};

Ports ports_of(const Usage& usage, const SetGates& set) {
  Ports ports;
  const Topology& topology = usage.resolved().topology;
  for (const PortUse& port : usage.ports())
    if (topology.nodes[port.node].name == set.node && (!set.to || topology.nodes[port.peer].name == *set.to))
      ports.push_back(&port);
  return ports;
}

}  // namespace

void report_ineffective_gates(const Usage& usage, json::Diagnostics& diagnostics) {
  GatesTeller teller(usage, diagnostics);
  for (const EgressUse& use : usage.egress())
    if (use.egress->gates) teller.run(*use.egress->gates, use.ports, {});
  const Scenario& scenario = usage.resolved().scenario;
  for (const ScriptEntry& entry : scenario.script)
    if (entry.set_gates) teller.run(entry.set_gates->gates, ports_of(usage, *entry.set_gates), entry.at);
  // Lists that were laid out have no place of their own.
  if (scenario.gates && !usage.resolved().gates)
    for (const SetGates& set : scenario.gates->lists) teller.run(set.gates, ports_of(usage, set), {});
}

/// What is to be dropped where nothing ever is.
void report_ineffective_drops(const Queues& queues, json::Diagnostics& diagnostics) {
  const auto tell = [&](const json::Source& where) {
    if (where.has("drop"))
      warn_once(diagnostics, where.at("drop"), "what a full queue loses, of queues that are never full",
                {"neither \"frames\" nor \"octets\"", "a limit"});
  };
  const bool are_limited = queues.frames || queues.octets;
  bool acts = are_limited || queues.drop == Queues{}.drop;  // what stands in every written copy tells nothing
  for (const Queues::PerClass& one : queues.classes) {
    if (!one.frames && !one.octets && !are_limited)
      tell(one.where);
    else
      acts = acts || !one.drop;
  }
  if (!acts) tell(queues.where);
}

void report_ineffective_queues(const Usage& usage, json::Diagnostics& diagnostics) {
  const Resolved& r = usage.resolved();
  std::map<std::string, std::pair<const Queues::PerClass*, Ports>> limits;  // by place: generated nodes share theirs
  for (std::uint32_t n = 0; n < r.topology.nodes.size(); ++n) {
    const Queues& queues = std::visit([](const auto& node) -> const Queues& { return node.queues; },
                                      r.topology.nodes[n].description.get());
    report_ineffective_drops(queues, diagnostics);
    for (const Queues::PerClass& one : queues.classes) {
      auto& [limit, ports] = limits[one.where.place().pointer];
      limit = &one;
      for (const PortUse& port : usage.ports())
        if (port.node == n) ports.push_back(&port);
    }
  }
  for (const auto& [pointer, limit] : limits) {
    const auto& [one, ports] = limit;
    const models::TrafficClass q = one->traffic_class;
    if (std::any_of(ports.begin(), ports.end(), [q = q](const PortUse* port) { return port->uses(q); })) continue;
    warn_once(diagnostics, one->where.at("class"), "a limit of a queue that no stream uses",
              {"class " + std::to_string(q) + " at " + usage.name(ports) + ": " + usage.why_unused(q, ports),
               usage.classes_in_use(ports)});
  }
  for (const TopologyNode& node : r.topology.nodes) {
    const Relay* const relay = relay_of(node.description);
    if (relay == nullptr) continue;
    if (relay->forwarding_jitter &&
        !r.plan.nodes[static_cast<std::size_t>(&node - r.topology.nodes.data())].forwarding_jitter)
      warn_once(diagnostics, relay->forwarding_jitter->where.place(), "a jitter of nothing", {"at most 0s", "a time"});
    if (!node.where.has("cut_through_header") || relay->cut_through_header == Relay{}.cut_through_header) continue;
    if (std::ranges::all_of(ports_of(node.description).egress,
                            [](const Egress& egress) { return egress.cut_through.empty(); }))
      warn_once(diagnostics, node.where.at("cut_through_header"), "a header where nothing is cut through",
                {"no \"cut_through\" in \"egress\" of " + json::quote(node.name), "classes that are cut through"});
  }
}

}  // namespace takt::scenario
