// SPDX-License-Identifier: Apache-2.0
#include "analysis/assessment.hpp"

#include <algorithm>
#include <set>
#include <string_view>

#include "analysis/gate_beginning.hpp"
#include "json/quantity.hpp"
#include "results/run_result.hpp"
#include "scenario/figures/requirement.hpp"
#include "scenario/resolve/clock_groups.hpp"
#include "scenario/resolve/gptp_links.hpp"

namespace takt::analysis {
namespace {

using json::to_text;
using sim::Duration;

class Assessor {
 public:
  Assessor(const scenario::Resolved& r, const FlowGraph& graph, const BoundOptions& options)
      : r_(r), graph_(graph), options_(options) {}

  AssumptionLedger run() {
    assess_clocks();
    assess_gates();
    assess_disturbances();
    assess_beginning();
    return std::move(ledger_);
  }

 private:
  const std::string& name_of(models::NodeIndex node) const { return r_.plan.nodes[node.value].name; }
  bool happens(const scenario::ResolvedAction& action) const { return action.at.since_start() < r_.scenario.duration; }

  void assess_clocks() {
    if (r_.plan.gptp.empty()) return;
    const ClockPremise premise = clock_premise(r_, options_);
    const std::string text = "clocks of the nodes on a way within " + to_text(premise.difference()) + " of each other";
    ledger_.state(Assumption::clock_difference,
                  premise.after > Duration() ? text + " from " + to_text(premise.after) + " on" : text, premise.after);
    if (premise.requirement && r_.requirements[*premise.requirement].given) {
      ledger_.state(Assumption::clock_difference, promise_text(r_.requirements[*premise.requirement], premise),
                    premise.after);
      ledger_.give(Assumption::clock_difference, "given by the scenario; no run of takt verify may show more");
    } else if (!premise.requirement)
      ledger_.leave_open(Assumption::clock_difference,
                         "no requirement \"sync\" or \"clocks\" says how far clocks may differ, and since when");
    else
      ledger_.leave_open(Assumption::clock_difference, "synchronisation is simulated, not bounded");
    if (const std::string why = why_apart(); !why.empty()) ledger_.violate(Assumption::clock_difference, why);
  }

  /// "clocks are within 1us of the grandmaster from 2s on".
  static std::string promise_text(const scenario::RequiredFigure& required, const ClockPremise& premise) {
    const bool is_of_grandmaster = required.kind == results::RequirementKind::sync;
    std::string text = "clocks are within " + to_text(*required.longest) +
                       (is_of_grandmaster ? " of the grandmaster" : " of each other");
    return premise.after > Duration() ? text + " from " + to_text(premise.after) + " on" : text;
  }

  /// Nodes whose ways meet, and which gPTP leaves with different grandmasters; empty: there are none.
  std::string why_apart() const {
    const std::vector<std::vector<std::uint32_t>> parts = scenario::gptp_parts(r_);
    if (parts.size() < 2) return {};
    constexpr std::size_t none = ~std::size_t{0};
    std::vector<std::size_t> part_of(r_.plan.nodes.size(), none);
    for (std::size_t p = 0; p < parts.size(); ++p)
      for (const std::uint32_t node : parts[p]) part_of[node] = p;
    for (const std::vector<std::uint32_t>& joined : scenario::nodes_joined_by_ways(r_)) {
      const auto first = std::ranges::find_if(joined, [&](std::uint32_t node) { return part_of[node] != none; });
      if (first == joined.end()) continue;
      const auto other = std::ranges::find_if(
          joined, [&](std::uint32_t node) { return part_of[node] != none && part_of[node] != part_of[*first]; });
      if (other != joined.end())
        return "no gPTP comes from " + name_of(models::NodeIndex{*first}) + " to " +
               name_of(models::NodeIndex{*other}) + too_long_link();
    }
    return {};
  }
  std::string too_long_link() const {
    for (const models::LinkPlan& link : r_.plan.links)
      if (r_.plan.gptp[link.a.node.value] && r_.plan.gptp[link.b.node.value] &&
          scenario::capability_of(r_, link) == scenario::LinkCapability::never)
        return ": the link from " + name_of(link.a.node) + " to " + name_of(link.b.node) + " shows a delay of " +
               to_text(scenario::shown_link_delay(r_, link).mean()) + ", beyond the threshold of " +
               to_text(scenario::link_delay_threshold(*r_.scenario.clocks.gptp, link).value_or(Duration()));
    return {};
  }

  void assess_gates() {
    GateBeginning beginning(r_, options_);
    const Duration begin = beginning.latest_of_all();
    ledger_.state(Assumption::gates_in_force, "gate lists run", begin);
    ledger_.discharge(Assumption::gates_in_force, "their base times");
    Duration changed;
    for (const scenario::ResolvedAction& action : r_.script) {
      const auto* const gates = std::get_if<scenario::ResolvedGates>(&action.what);
      if (gates == nullptr || !happens(action)) continue;
      changed = std::max(changed, beginning.latest(gates->node, gates->gates, action.at.since_start()));
    }
    ledger_.state(Assumption::gates_do_not_change, "no gate list is exchanged", changed);
    ledger_.discharge(Assumption::gates_do_not_change, "the script");
  }

  /// What is over at some instant is no disturbance from then on.
  void assess_disturbances() {
    Duration over;
    std::vector<std::tuple<std::uint32_t, std::uint16_t, models::TrafficClass>> stuck;
    for (const scenario::ResolvedAction& action : r_.script) {
      if (!happens(action)) continue;
      if (const auto* const gate = std::get_if<scenario::ResolvedStuckGate>(&action.what)) {
        over = std::max(over, action.at.since_start());
        const std::tuple place(gate->node.value, gate->port, gate->traffic_class);
        std::erase(stuck, place);
        if (gate->open) stuck.push_back(place);
      }
      if (const auto* const bypass = std::get_if<scenario::ResolvedBypass>(&action.what);
          bypass != nullptr && !r_.plan.gptp.empty())
        ledger_.violate(Assumption::no_disturbance, "the bypass of " + name_of(bypass->node) +
                                                        " joins its neighbours at " + to_text(action.at.since_start()) +
                                                        ", and no bound of clock errors follows gPTP over it");
      if (const auto* const fault = std::get_if<scenario::ResolvedClockFault>(&action.what)) {
        over = std::max(over, action.at.since_start());
        jumps_at_start_ = jumps_at_start_ || action.at == sim::TrueTime();
        if (fault->offset)
          ledger_.violate(Assumption::no_disturbance, "the clock of " + name_of(fault->node) +
                                                          " gets another frequency at " +
                                                          to_text(action.at.since_start()));
      }
    }
    ledger_.state(Assumption::no_disturbance, "no gate is stuck, no clock jumps, no frame goes in circles", over);
    if (!stuck.empty()) {
      const auto& [node, port, traffic_class] = stuck.front();
      ledger_.violate(Assumption::no_disturbance, "the gate of class " + std::to_string(traffic_class) + " at " +
                                                      name_of(models::NodeIndex{node}) + ":" + std::to_string(port) +
                                                      " is stuck to the end");
    }
    if (!graph_.uncertain_paths.empty())
      ledger_.violate(Assumption::no_disturbance, "frames of " + graph_.uncertain_paths.front() +
                                                      " may go in circles, or on too many ways to look at");
    ledger_.discharge(Assumption::no_disturbance, "the scenario");
  }

  void assess_beginning() {
    Duration last;
    for (const Assumption each : {Assumption::clock_difference, Assumption::gates_in_force,
                                  Assumption::gates_do_not_change, Assumption::no_disturbance})
      if (graph_.assumptions.contains(each)) last = std::max(last, ledger_[each].holds_from);
    // What a talker sends that a jump has made late comes at that very instant.
    if (last == Duration() && !jumps_at_start_) {
      ledger_.discharge(Assumption::drained, "everything holds from the start");
      return;
    }
    ledger_.state(Assumption::drained, "what was sent before " + to_text(last) + " has left the network", last);
    if (is_given_with_clocks(last))
      ledger_.give(Assumption::drained, "given with the clocks: what is promised is the plant in operation");
    else
      ledger_.leave_open(Assumption::drained, "how long that takes is not bounded");
  }

  /// A data sheet promises the clocks, and all else holds when they do.
  bool is_given_with_clocks(Duration last) const {
    const AssessedAssumption& clocks = ledger_[Assumption::clock_difference];
    return graph_.assumptions.contains(Assumption::clock_difference) && clocks.standing == Standing::condition &&
           clocks.holds_from == last && !jumps_at_start_;
  }

  const scenario::Resolved& r_;
  const FlowGraph& graph_;
  const BoundOptions& options_;
  AssumptionLedger ledger_;
  bool jumps_at_start_ = false;  // a clock
};

/// Whether the nodes are all whose clocks matter: those with gPTP on ways.
bool are_all_on_ways(const scenario::Resolved& resolved, const scenario::Names& clocks) {
  if (scenario::clock_group_name(clocks) == scenario::all_clocks) return true;
  const std::set<std::string_view> names(clocks.names.begin(), clocks.names.end());
  for (const std::vector<std::uint32_t>& joined : scenario::nodes_joined_by_ways(resolved))
    for (const std::uint32_t node : joined)
      if (resolved.plan.gptp[node] && !names.contains(resolved.plan.nodes[node].name)) return false;
  return true;
}

/// How far each clock is from one time at most, if the requirement says it of all that matter.
std::optional<Duration> clock_error_by(const scenario::Resolved& resolved, const scenario::RequiredFigure& required) {
  if (required.kind == results::RequirementKind::sync && required.subject.empty()) return required.longest;
  if (required.kind != results::RequirementKind::clocks || resolved.plan.gptp.empty() ||
      !are_all_on_ways(resolved, *resolved.scenario.require[required.entry].clocks))
    return std::nullopt;
  return Duration::from_ps((required.longest->ps() + 1) / 2);
}

}  // namespace

ClockPremise clock_premise(const scenario::Resolved& resolved, const BoundOptions& options) {
  ClockPremise premise{options.clock_error, Duration(), std::nullopt};
  const auto is_given = [&](const scenario::RequiredFigure& required) {
    return required.given && clock_error_by(resolved, required);
  };
  const bool given_alone = std::ranges::any_of(resolved.requirements, is_given);  // others are asked for, not promised
  for (std::size_t i = 0; i < resolved.requirements.size(); ++i) {
    const std::optional<Duration> error = clock_error_by(resolved, resolved.requirements[i]);
    if (!error || (given_alone && !resolved.requirements[i].given)) continue;
    const Duration from = resolved.requirements[i].from;
    // The weakest one is a consequence of each of the others, from whenever that holds.
    premise.after = premise.requirement ? std::min(premise.after, from) : from;
    if (!premise.requirement || *error > premise.error) {
      premise.error = *error;
      premise.requirement = i;
    }
  }
  return premise;
}

AssumptionLedger assess(const scenario::Resolved& resolved, const FlowGraph& graph, const BoundOptions& options) {
  return Assessor(resolved, graph, options).run();
}

}  // namespace takt::analysis
