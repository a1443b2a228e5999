#include "scenario/resolve/gates.hpp"

#include <algorithm>
#include <utility>

#include "scenario/gates/layout.hpp"
#include "scenario/resolve/egress.hpp"
#include "scenario/resolve/port_configs.hpp"

namespace takt::scenario {
namespace {

class GateResolver {
 public:
  GateResolver(Resolved& resolved, json::Diagnostics& diagnostics) : r_(resolved), gates_(*resolved.scenario.gates), diagnostics_(diagnostics) {}

  void run() {
    const bool is_sound = check_keys();
    // Windows are laid along the paths of a network that is right.
    if (!is_sound || diagnostics_.has_errors()) return;
    if (gates_.plan == GatePlanning::automatic) lay_out();
    for (std::size_t i = 0; i < gates_.lists.size(); ++i) apply(gates_.lists[i], i);
  }

 private:
  bool check_keys() {
    const std::size_t errors_before = diagnostics_.errors();
    if (diagnostics_.is_refused(gates_.where.at("plan"))) return false;  // nobody knows what belongs to it
    // By value: the resolved copy writes what is empty, too.
    const auto refuse = [&](bool is_there, const char* key, GatePlanning plan) {
      if (is_there && gates_.plan != plan)
        diagnostics_.error(gates_.where.at(key), "does not belong to this plan of gates", {json::quote(key), "it with \"plan\": " + json::quote(spelling(plan))});
    };
    refuse(gates_.margin.has_value(), "margin", GatePlanning::automatic);
    refuse(!gates_.classes.empty(), "classes", GatePlanning::automatic);
    refuse(gates_.guard != GateGuard::length_aware, "guard", GatePlanning::automatic);
    refuse(!gates_.lists.empty(), "lists", GatePlanning::listed);
    return diagnostics_.errors() == errors_before;
  }

  void lay_out() {
    auto problem = gate_problem_of(r_, diagnostics_);
    if (!problem) return;
    GateLayout layout = lay_out_gates(*problem);
    for (const GateConflict& conflict : layout.conflicts) report(*problem, conflict);
    if (!layout.conflicts.empty()) return;
    NetworkGates listed;
    listed.where = gates_.where;
    listed.plan = GatePlanning::listed;
    for (std::size_t p = 0; p < problem->ports.size(); ++p) listed.lists.push_back(list_of(problem->ports[p], layout.schedule.lists[p]));
    gates_ = std::move(listed);
    r_.gates = GatePlan{std::move(*problem), std::move(layout.schedule)};
  }

  SetGates list_of(const GatedPort& port, const GateList& list) const {
    SetGates set;
    set.where = gates_.where;
    set.node = r_.topology.nodes[port.node.value].name;
    for (const Neighbour& neighbour : r_.topology.neighbours[port.node.value])
      if (neighbour.port == port.port) set.to = r_.topology.nodes[neighbour.node].name;
    set.gates.where = gates_.where;
    set.gates.cycle = list.cycle;
    for (const GateList::Entry& entry : list.entries) {
      GateEntry made;
      made.where = gates_.where;
      for (models::TrafficClass q = 0; q < models::traffic_class_count; ++q)
        if ((entry.open >> q & 1) != 0) made.open.push_back(q);
      made.interval = entry.interval;
      set.gates.entries.push_back(std::move(made));
    }
    return set;
  }

  void report(const GateProblem& problem, const GateConflict& conflict) {
    const std::string& first = problem.streams[conflict.first].name;
    const std::string& second = problem.streams[conflict.second].name;
    const std::string& port = problem.ports[conflict.port].name;
    const auto from_to = [](Duration from, Duration until) { return json::to_text(from) + " to " + json::to_text(until); };
    if (conflict.kind == GateConflict::Kind::cycle_too_long) {
      diagnostics_.error(gates_.where.place(), "gates with too long a cycle",
                         {"at " + json::quote(port) + " " + std::to_string(conflict.entries) + " entries or more in a cycle of " + json::to_text(conflict.cycle) + ", with " +
                              json::quote(first) + " every " + json::to_text(problem.streams[conflict.first].period) + " and " + json::quote(second) + " every " +
                              json::to_text(problem.streams[conflict.second].period),
                          "periods with a common multiple that takes at most " + std::to_string(most_gate_entries) + " entries and " + json::to_text(longest_gate_cycle)});
      return;
    }
    if (conflict.kind == GateConflict::Kind::order) {
      const auto when = [&](Duration from, Duration until) { return from == until ? "at " + json::to_text(from) : "from " + from_to(from, until); };
      diagnostics_.error(gates_.where.place(), "frames that may come in any order",
                         {"at " + json::quote(port) + " " + json::quote(first) + " " + when(conflict.first_from, conflict.first_until) + " and " + json::quote(second) + " " +
                              when(conflict.second_from, conflict.second_until) + " of their periods, as operating system and jitter go",
                          "phases that are further apart, or another class, so that the first does not wait in the other's window"});
      return;
    }
    const std::string every = " of each " + json::to_text(conflict.cycle);
    diagnostics_.error(gates_.where.place(), "windows that overlap",
                       {"at " + json::quote(port) + " " + json::quote(first) + " from " + from_to(conflict.first_from, conflict.first_until) + " and " + json::quote(second) + " from " +
                            from_to(conflict.second_from, conflict.second_until) + every,
                        conflict.first == conflict.second ? "a period that is longer than the window" : "an \"offset\" or \"phases\" that keep them apart"});
  }

  void apply(const SetGates& set, std::size_t index) {
    const auto node = r_.topology.find(set.node);
    // Lists that were laid out have no place of their own.
    const json::Source& where = set.where;
    if (!node) {
      report_unknown_node(r_.topology, set.node, where.at("node"), "the name of a node", diagnostics_);
      return;
    }
    const models::GateConfig gates = gate_config_of(set.gates, diagnostics_);
    const GatesSet done = set_gates(r_.plan, models::NodeIndex{*node}, gates, [&](models::NodeIndex peer) { return !set.to || r_.topology.nodes[peer.value].name == *set.to; });
    if (!done.found) report_no_neighbour(r_.topology, set.to.value_or(set.node), set.node, where.at(set.to ? "to" : "node"), diagnostics_);
    if (done.twice) diagnostics_.error(gates_.where.at("lists", index), "a port configured twice", {"gates of " + json::quote(set.node) + " that are there already", "one list for a port"});
  }

  Resolved& r_;
  NetworkGates& gates_;
  json::Diagnostics& diagnostics_;
};

}  // namespace

void resolve_gates(Resolved& resolved, json::Diagnostics& diagnostics) {
  if (resolved.scenario.gates) GateResolver(resolved, diagnostics).run();
}

}  // namespace takt::scenario
