// SPDX-License-Identifier: Apache-2.0
#include "scenario/gates/resolve_gates.hpp"

#include <algorithm>
#include <utility>

#include "scenario/gates/beginning.hpp"
#include "scenario/gates/layout.hpp"
#include "scenario/resolve/egress.hpp"
#include "scenario/resolve/gate_limits.hpp"
#include "scenario/gates/resolve_offsets.hpp"
#include "scenario/resolve/port_configs.hpp"

namespace takt::scenario {
namespace {

class GateResolver {
 public:
  GateResolver(Resolved& resolved, Timings& timings, json::Diagnostics& diagnostics)
      : r_(resolved), timings_(timings), gates_(*resolved.scenario.gates), diagnostics_(diagnostics) {}

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
        diagnostics_.error(gates_.where.at(key), "does not belong to this plan of gates",
                           {json::quote(key), "it with \"plan\": " + json::quote(spelling(plan))});
    };
    refuse(gates_.margin.has_value(), "margin", GatePlanning::automatic);
    if (gates_.plan == GatePlanning::automatic && gates_.margin && gates_.margin->is_auto)
      diagnostics_.error(
          gates_.where.at("margin"), "a margin that is not known yet",
          {"\"auto\"", "a duration, or takt schedule SCENARIO --out FILE, which measures it, and then FILE"});
    refuse(!gates_.classes.empty(), "classes", GatePlanning::automatic);
    refuse(gates_.guard != GateGuard::length_aware, "guard", GatePlanning::automatic);
    refuse(!gates_.lists.empty(), "lists", GatePlanning::listed);
    return diagnostics_.errors() == errors_before;
  }

  void lay_out() {
    auto gated = gate_problem_of(r_, timings_, diagnostics_);
    if (!gated || !choose_gated_offsets(r_, timings_, *gated, diagnostics_)) return;
    GateProblem& problem = gated->problem;
    GateLayout layout = lay_out_gates(problem);
    report(*gated, layout.conflicts);
    if (!layout.conflicts.empty()) return;
    NetworkGates listed;
    listed.where = gates_.where;
    listed.plan = GatePlanning::listed;
    Duration begins;
    for (std::size_t p = 0; p < problem.ports.size(); ++p) {
      const BegunList begun = begun_at(problem, p, layout.schedule.lists[p]);
      begins = std::max(begins, begun.base_time);
      listed.lists.push_back(list_of(problem.ports[p], layout.schedule.lists[p].cycle, begun));
    }
    gates_ = std::move(listed);
    r_.gates = GatePlan{std::move(problem), std::move(layout.schedule), begins};
  }

  /// When clocks are synchronised; lists that would begin after the end begin at the start.
  BegunList begun_at(const GateProblem& problem, std::size_t port, const GateList& list) const {
    const Duration from = clocks_synchronised_from(r_.scenario).value_or(Duration());
    if (from == Duration() || from >= r_.scenario.duration || list.entries.empty()) return {{}, list.entries};
    models::GateStates scheduled = 0;
    for (const ScheduledStream& stream : problem.streams)
      for (const ScheduledHop& hop : stream.hops)
        if (hop.port == port) scheduled = models::with(scheduled, hop.traffic_class);
    return begun_list(list, problem.ports[port], scheduled, from);
  }

  SetGates list_of(const GatedPort& port, Duration cycle, const BegunList& list) const {
    SetGates set;
    set.where = gates_.where;
    set.node = r_.topology.nodes[port.node.value].name;
    const std::vector<Neighbour>& neighbours = r_.topology.neighbours[port.node.value];
    const Neighbour& peer = *std::ranges::find(neighbours, port.port, &Neighbour::port);
    set.to = r_.topology.nodes[peer.node].name;
    if (std::ranges::count(neighbours, peer.node, &Neighbour::node) > 1)
      *set.to += ":" + std::to_string(peer.their_port);
    set.gates.where = gates_.where;
    set.gates.cycle = cycle;
    set.gates.base_time = list.base_time;
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

  /// At the streams that make them: of two the later one in the file. All that is of one kind at one place is one
  /// diagnostic.
  void report(const StreamsToGate& gated, const std::vector<GateConflict>& conflicts) {
    std::vector<Grouped> groups;
    for (const GateConflict& conflict : conflicts) {
      const json::Place place =
          conflict.kind == GateConflict::Kind::limits
              ? limits_place(gated.problem.ports[conflict.port])
              : r_.streams[gated.streams[std::max(conflict.first, conflict.second)].value].where.at(
                    conflict.kind == GateConflict::Kind::cycle_too_long ? "every" : "offset");
      const bool meets_itself = conflict.kind != GateConflict::Kind::limits && conflict.first == conflict.second;
      const auto same = [&](const Grouped& each) {
        return each.kind == conflict.kind && each.meets_itself == meets_itself && each.place.pointer == place.pointer;
      };
      auto group = std::ranges::find_if(groups, same);
      if (group == groups.end()) group = groups.insert(groups.end(), {conflict.kind, meets_itself, place, {}, 0});
      ++group->count;
      if (group->first.size() < 3) group->first.push_back(words_of(gated.problem, conflict));
    }
    for (const Grouped& group : groups) {
      std::string found;
      for (const std::string& one : group.first) found += (found.empty() ? "" : "; ") + one;
      if (group.count > group.first.size())
        found += "; and " + std::to_string(group.count - group.first.size()) + " more";
      tell(group, std::move(found));
    }
  }

  json::Place limits_place(const GatedPort& port) const {
    const auto& limits = ports_of(r_.topology.nodes[port.node.value].description).gate_limits;
    return limits ? limits->where.place() : gates_.where.place();
  }

  struct Grouped {
    GateConflict::Kind kind = GateConflict::Kind::overlap;
    bool meets_itself = false;
    json::Place place;
    std::vector<std::string> first;
    std::size_t count = 0;
  };

  void tell(const Grouped& group, std::string found) {
    switch (group.kind) {
      case GateConflict::Kind::cycle_too_long:
        diagnostics_.error(
            group.place, too_long_a_cycle,
            {std::move(found), "periods with a common multiple of at most " + json::to_text(longest_gate_cycle) +
                                   " and " + std::to_string(most_windows_of_a_list) +
                                   " windows, and frames that wait for no window where there are more than " +
                                   std::to_string(most_gate_entries) + " entries"});
        return;
      case GateConflict::Kind::limits:
        diagnostics_.error(
            group.place, beyond_the_device,
            {std::move(found), "limits that leave room for the scheduled frames, or fewer or shorter of these"});
        return;
      case GateConflict::Kind::order:
        diagnostics_.error(group.place, "frames that may come in any order",
                           {std::move(found),
                            "\"offset\": \"auto\", phases that are further apart, or another class, so that the first "
                            "does not wait in the other's window"});
        return;
      case GateConflict::Kind::overlap:
        diagnostics_.error(
            group.place, "windows that overlap",
            {std::move(found), group.meets_itself
                                   ? "a period that is longer than the window; of copies that come by several ways, "
                                     "paths that take longer by more than a window"
                                   : "\"offset\": \"auto\", or offsets or \"phases\" that keep them apart"});
    }
  }

  static std::string words_of(const GateProblem& problem, const GateConflict& conflict) {
    const std::string first = json::quote(problem.streams[conflict.first].name);
    const std::string second = json::quote(problem.streams[conflict.second].name);
    if (conflict.kind == GateConflict::Kind::limits) return words_of_limits(problem.ports[conflict.port], conflict);
    const std::string at = "at " + json::quote(problem.ports[conflict.port].name) + " ";
    const auto from_to = [](Duration from, Duration until) {
      return json::to_text(from) + " to " + json::to_text(until);
    };
    if (conflict.kind == GateConflict::Kind::cycle_too_long)
      return at + std::to_string(conflict.entries) + " windows or entries in a cycle of " +
             json::to_text(conflict.cycle) + ", with " + first + " every " +
             json::to_text(problem.streams[conflict.first].period) + " and " + second + " every " +
             json::to_text(problem.streams[conflict.second].period);
    if (conflict.kind == GateConflict::Kind::order) {
      const auto when = [&](Duration from, Duration until) {
        return from == until ? "at " + json::to_text(from) : "from " + from_to(from, until);
      };
      return at + first + " " + when(conflict.first_from, conflict.first_until) + " and " + second + " " +
             when(conflict.second_from, conflict.second_until) + " of their periods, as operating system and jitter go";
    }
    return at + first + " from " + from_to(conflict.first_from, conflict.first_until) + " and " + second + " from " +
           from_to(conflict.second_from, conflict.second_until) + " of each " + json::to_text(conflict.cycle);
  }

  /// What the port needs, and what would do.
  static std::string words_of_limits(const GatedPort& port, const GateConflict& conflict) {
    const std::string name = json::quote(port.name);
    switch (conflict.obstacle) {
      case ListObstacle::entries:
        return name + " needs " + std::to_string(conflict.entries) + " entries, the device has " +
               std::to_string(port.limits.entries) + "; with " + std::to_string(conflict.entries) + " it holds";
      case ListObstacle::cycle:
        return "the cycle of " + name + ", " + json::to_text(conflict.cycle) +
               ", is no multiple of the granularity of " + json::to_text(port.limits.granularity) +
               "; with periods that are it holds";
      case ListObstacle::waiting:
        return name + " has windows that frames wait for, which cannot be changed for intervals of " +
               json::to_text(port.limits.least_interval) + " and a granularity of " +
               json::to_text(port.limits.granularity);
      case ListObstacle::no_time:
      case ListObstacle::none:
        break;
    }
    return name + " would never open for other classes, with intervals of at least " +
           json::to_text(port.limits.least_interval) + " that are multiples of " +
           json::to_text(port.limits.granularity);
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
    const auto is_meant = [&](const models::LinkPlan::End& peer) {
      return !set.to || r_.topology.is_named(*set.to, peer.node.value, peer.port);
    };
    const GatesSet done = set_gates(r_.plan, models::NodeIndex{*node}, gates, is_meant);
    if (!done.found)
      report_no_neighbour(r_.topology, set.to.value_or(set.node), set.node, where.at(set.to ? "to" : "node"),
                          diagnostics_);
    if (done.twice)
      diagnostics_.error(gates_.where.at("lists", index), "a port configured twice",
                         {"gates of " + json::quote(set.node) + " that are there already", "one list for a port"});
  }

  Resolved& r_;
  Timings& timings_;
  NetworkGates& gates_;
  json::Diagnostics& diagnostics_;
};

}  // namespace

void resolve_gates_and_offsets(Resolved& resolved, json::Diagnostics& diagnostics) {
  Timings timings;
  if (!diagnostics.has_errors()) timings = timings_of(resolved);
  if (resolved.scenario.gates) GateResolver(resolved, timings, diagnostics).run();
  if (!diagnostics.has_errors()) choose_other_offsets(resolved, timings, diagnostics);
  if (diagnostics.has_errors()) return;
  for (Program& program : resolved.scenario.programs) {
    if (!program.offset || !program.offset->is_auto) continue;
    diagnostics.warning(program.where.at("offset"), "an offset that nobody gets",
                        {"\"auto\" beside \"phases\" of all participants", "one of them"});
    program.offset = Duration();
  }
}

}  // namespace takt::scenario
