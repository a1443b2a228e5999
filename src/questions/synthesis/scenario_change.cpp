// SPDX-License-Identifier: Apache-2.0
#include "synthesis/scenario_change.hpp"

#include <algorithm>
#include <map>
#include <utility>

#include "json/fields.hpp"
#include "json/quantity.hpp"
#include "scenario/gates/timing.hpp"

namespace takt::synthesis {
namespace {

using scenario::GatePlan;
using scenario::GateProblem;
using scenario::Resolved;
using scenario::Scenario;
using scenario::ScheduledStream;
using scenario::Stream;
using sim::Duration;

/// Streams of the plant and of what runs are the same but for what takt chooses.
void check_plant(const Scenario& running, const Scenario& plant, json::Diagnostics& diagnostics) {
  if (!plant.gates || plant.gates->plan != scenario::GatePlanning::automatic)
    diagnostics.error(plant.where.at("gates"), "a plant without automatic gates",
                      {"no \"gates\": \"auto\"", "the scenario that takt schedule has made the schedule of"});
  for (const Stream& stream : running.streams) {
    const auto wish = std::ranges::find(plant.streams, stream.name, &Stream::name);
    if (wish == plant.streams.end()) {
      diagnostics.error(plant.where.at("streams"), "not the plant that runs",
                        {"no stream " + json::quote(stream.name), "all that the schedule has"});
      continue;
    }
    Stream same = *wish;
    if (!same.path) same.path = stream.path;
    if (!same.offset || same.offset->is_auto) same.offset = stream.offset;
    if (same != stream)
      diagnostics.error(wish->where.place(), "not the stream that runs",
                        {json::quote(stream.name) + " with other values", "those of the schedule"});
  }
  for (const Stream& stream : plant.streams)
    if (std::ranges::find(running.streams, stream.name, &Stream::name) == running.streams.end())
      diagnostics.error(stream.where.place(), "a stream that does not run",
                        {json::quote(stream.name), "it in the file of --add"});
}

/// Offset to release of the streams of "streams"; of what Programs publish nothing.
std::map<std::string, Duration> lags_of(const Resolved& resolved) {
  std::map<std::string, Duration> lags;
  for (const ScheduledStream& each : resolved.gates->problem.streams) {
    const auto written = std::ranges::find(resolved.scenario.streams, each.name, &Stream::name);
    if (written != resolved.scenario.streams.end())
      lags[each.name] = each.release - written->offset.value_or(Duration());
  }
  return lags;
}

/// All flows before and after in one problem: who stays, stands there once.
class Flows {
 public:
  Flows(const Resolved& before, const Resolved& after, const std::vector<StreamChange>& changes) : changes_(changes) {
    made_.problem.flows.margin = before.gates->problem.margin;
    made_.problem.changes.resize(changes.size());
    for (std::size_t c = 0; c < changes.size(); ++c) made_.problem.changes[c].may_pause = changes[c].was_cut;
    const auto lags_before = lags_of(before), lags_after = lags_of(after);
    for (const ScheduledStream& each : before.gates->problem.streams)
      first_fresh_train_ = std::max(first_fresh_train_, each.train + 1);
    for (std::size_t s = 0; s < before.gates->problem.streams.size(); ++s) {
      const FlowIndex flow = add(before.gates->problem, s, lags_before, false);
      if (const auto c = change_of(made_.names[flow])) made_.problem.changes[*c].leaves = flow;
    }
    for (std::size_t s = 0; s < after.gates->problem.streams.size(); ++s) {
      const auto c = change_of(after.gates->problem.streams[s].name);
      if (!c) continue;
      made_.problem.changes[*c].comes = add(after.gates->problem, s, lags_after, true);
    }
    made_.problem.lists.resize(made_.problem.flows.ports.size());
    for (std::uint32_t p = 0; p < made_.problem.flows.ports.size(); ++p)
      if (const scenario::GateList* const list = list_of(*before.gates, made_.problem.flows.ports[p]))
        made_.problem.lists[p] = *list;
  }
  ChangedFlows take() { return std::move(made_); }

  static const scenario::GateList* list_of(const GatePlan& plan, const scenario::GatedPort& port) {
    const auto found = std::ranges::find(plan.problem.ports, port.name, &scenario::GatedPort::name);
    return found == plan.problem.ports.end()
               ? nullptr
               : &plan.schedule.lists[static_cast<std::size_t>(found - plan.problem.ports.begin())];
  }

 private:
  std::optional<std::size_t> change_of(const std::string& name) const {
    const auto found = std::ranges::find(changes_, name, &StreamChange::name);
    return found == changes_.end() ? std::nullopt : std::optional(static_cast<std::size_t>(found - changes_.begin()));
  }

  FlowIndex add(const GateProblem& from, std::size_t s, const std::map<std::string, Duration>& lags, bool is_fresh) {
    ScheduledStream flow = from.streams[s];
    if (is_fresh) flow.train += first_fresh_train_;
    for (scenario::ScheduledHop& hop : flow.hops) {
      const scenario::GatedPort& port = from.ports[hop.port];
      auto& ports = made_.problem.flows.ports;
      const auto found = std::ranges::find(ports, port.name, &scenario::GatedPort::name);
      hop.port = static_cast<std::uint32_t>(found - ports.begin());
      if (found == ports.end()) ports.push_back(port);
    }
    const auto lag = lags.find(flow.name);
    made_.names.push_back(flow.name);
    made_.lags.push_back(lag == lags.end() ? Duration() : lag->second);
    made_.of_program.push_back(lag == lags.end());
    made_.problem.flows.streams.push_back(std::move(flow));
    return static_cast<FlowIndex>(made_.names.size() - 1);
  }

  const std::vector<StreamChange>& changes_;
  std::uint32_t first_fresh_train_ = 0;  // what comes follows nobody
  ChangedFlows made_;
};

/// All that runs has sent for two periods; whole ms.
Duration earliest_begin(const GateProblem& running) {
  Duration least;
  for (const ScheduledStream& stream : running.streams) least = std::max(least, stream.release + stream.period * 2);
  constexpr std::int64_t ms = 1'000'000'000;
  return Duration::from_ps((least.ps() + ms - 1) / ms * ms);
}

/// The lists at the end are those of the plant afterwards; ports without windows are open.
void compare_lists(const ScenarioChange& answer, std::vector<std::string>& wrong) {
  for (std::uint32_t p = 0; p < answer.transition.lists.size(); ++p) {
    const scenario::GatedPort& port = answer.flows.problem.flows.ports[p];
    const scenario::GateList& list = answer.transition.lists[p];
    const scenario::GateList* const shall = Flows::list_of(*answer.after->gates, port);
    const bool is_open = std::ranges::all_of(
        list.entries, [](const scenario::GateList::Entry& each) { return each.open == models::all_gates_open; });
    if (shall != nullptr ? list != *shall : !is_open)
      wrong.push_back("the transition ends with another list at " + json::quote(port.name));
  }
}

/// The plant as its user wrote it, with what has come and without what has gone.
Scenario changed_plant(const Scenario& plant, const std::vector<StreamChange>& changes, const AskedChanges& asked,
                       const PlacedChanges& placed) {
  Scenario made = plant;
  for (const StreamChange& change : changes) {
    if (change.fate == StreamFate::moves) continue;
    if (change.fate == StreamFate::comes)
      made.streams.push_back(*std::ranges::find(asked.add, change.name, &Stream::name));
    else
      std::erase_if(made.streams, [&](const Stream& stream) { return stream.name == change.name; });
    if (change.fate != StreamFate::comes)
      std::erase_if(made.require, [&](const scenario::Requirement& each) { return each.stream == change.name; });
  }
  for (const scenario::Requirement& each : asked.require)
    if (!each.stream || std::ranges::find(placed.without_place, *each.stream) == placed.without_place.end())
      made.require.push_back(each);
  for (const scenario::Fault& fault : placed.faults) made.faults.push_back(fault);
  return made;
}

}  // namespace

std::optional<ScenarioChange> change_scenario(const Scenario& running, const std::optional<Scenario>& plant,
                                              const AskedChanges& asked, json::Diagnostics& diagnostics) {
  check_changeable(running, diagnostics);
  if (plant) check_plant(running, *plant, diagnostics);
  if (diagnostics.has_errors()) return std::nullopt;
  const auto gates = gates_of_running(running, plant ? plant->gates : std::nullopt, asked.add, diagnostics);
  if (!gates) return std::nullopt;
  const Duration earliest = earliest_begin(gates->resolved->gates->problem);
  if (asked.at && *asked.at < earliest)
    diagnostics.error({"--at", 0, 0, ""}, "a change that begins too early",
                      {json::to_text(*asked.at),
                       "at least " + json::to_text(earliest) + ", when all streams have sent for two periods"});
  auto placed = place_changes(running, *gates, plant ? &*plant : nullptr, asked, diagnostics);
  if (!placed || diagnostics.has_errors()) return std::nullopt;
  ScenarioChange answer;
  answer.how = placed->why_not;
  answer.changes = placed->changes;
  answer.without_place = placed->without_place;
  answer.without_way = placed->without_way;
  if (!answer.how.empty()) return answer;
  // What windows, simulator and bounds say of the plant afterwards.
  ScenarioOptions options;
  options.may_route = false;
  options.entries = asked.entries;
  options.search.attempts = 1;
  auto scheduled = schedule_scenario(placed->after, options, diagnostics);
  if (!scheduled || diagnostics.has_errors()) return std::nullopt;
  for (const std::string& each : scheduled->wrong) answer.wrong.push_back("afterwards: " + each);
  if (scheduled->verdict != schedule::Decision::Verdict::scheduled || !scheduled->resolved) {
    // What the resolver says where it finds no windows is about a search that there was none of.
    answer.how = scheduled->how.empty() || scheduled->how.starts_with("no offsets found")
                     ? "the places that were found are none in whole ns, or for frames that may be early at their "
                       "talkers (jitter, operating systems)"
                     : scheduled->how;
    return answer;
  }
  answer.plant = plant ? changed_plant(*plant, placed->changes, asked, *placed) : placed->after;
  answer.flows = Flows(*gates->resolved, *scheduled->resolved, placed->changes).take();
  answer.at = asked.at.value_or(earliest);
  answer.flows.problem.begin = placed->faults.empty() ? answer.at : answer.at + asked.lead;
  answer.flows.problem.lead = asked.lead;
  answer.transition = plan_transition(answer.flows.problem);
  if (!answer.transition.stuck.empty()) {
    for (const std::size_t c : answer.transition.stuck) answer.would_pause.push_back(placed->changes[c].name);
    answer.how = "no order of steps keeps all streams running: " + answer.transition.why;
    return answer;
  }
  answer.after = std::move(scheduled->resolved);
  compare_lists(answer, answer.wrong);
  answer.simulated =
      make_transition_scenario(running, *gates->resolved, *placed, answer.flows, answer.transition, answer.at);
  answer.verdict = judge_transition(answer.simulated);
  // How far clocks are off is no promise of takt: the simulator says whether windows leave room enough, above all where
  // what fails was on the way of gPTP.
  if ((running.clocks.all || !running.clocks.nodes.empty()) && !answer.verdict.wrong.empty()) {
    answer.how = "with these clocks windows do not keep while it changes: " + answer.verdict.wrong.front();
    answer.after.reset();
    return answer;
  }
  for (const std::string& each : answer.verdict.wrong) answer.wrong.push_back("simulator: " + each);
  const bool is_lost =
      std::ranges::any_of(answer.changes, [](const StreamChange& change) { return change.fate == StreamFate::lost; });
  answer.is_done = answer.without_place.empty() && !is_lost;
  return answer;
}

const json::Object& describe(json::Type<ComingStreams>) {
  static constexpr json::Field fields[] = {
      json::required<&ComingStreams::streams>("streams", "Streams that come.", {.min_items = 1}),
      json::optional<&ComingStreams::require>("require", "What is required of them."),
  };
  static constexpr json::Object table =
      json::object<ComingStreams>("coming_streams", "Streams that come to a plant that runs.", fields);
  return table;
}

}  // namespace takt::synthesis
