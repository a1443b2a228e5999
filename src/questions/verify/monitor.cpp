// SPDX-License-Identifier: Apache-2.0
#include "verify/monitor.hpp"

#include <algorithm>

#include "analysis/assessment.hpp"
#include "json/quantity.hpp"

namespace takt::verify {
namespace {

using analysis::Assumption;
using json::to_text;

/// As Assumption::program_publishes has it.
constexpr std::size_t most_changes_in_a_cycle = 4;

std::string with_seed(const results::RunResult& result) { return " in a run with seed " + std::to_string(result.seed); }

void look_at_clocks(const scenario::Run& run, const results::RunResult& result, std::vector<Violation>& found) {
  const scenario::Resolved& resolved = run.resolved();
  const analysis::ClockPremise premise = analysis::clock_premise(resolved, {});
  if (!premise.requirement) return;
  for (std::size_t g = 0; g < run.clocks()->groups().size(); ++g) {
    if (!run.clocks()->groups()[g].name.starts_with(scenario::clocks_on_ways)) continue;
    const scenario::ClockDifferences& seen = run.clocks()->differences(g).from(premise.after);
    if (seen.samples > 0 && seen.greatest > premise.difference())
      found.push_back({Assumption::clock_difference, resolved.plan.nodes[seen.ahead.value].name + " is " +
                                                         to_text(seen.greatest) + " ahead of " +
                                                         resolved.plan.nodes[seen.behind.value].name + " at " +
                                                         to_text(seen.at.since_start()) + with_seed(result)});
  }
  // Clocks that follow several grandmasters are as near to each other as they happen to be.
  for (const results::RequirementResult& each : result.requirements)
    if (each.requirement == premise.requirement && !result.partial && each.verdict != results::Verdict::pass)
      found.push_back({Assumption::clock_difference, (each.measured ? to_text(*each.measured) : "no sample") +
                                                         with_seed(result) +
                                                         (each.remark.empty() ? "" : ": " + each.remark)});
}

/// In the whole run: invariants have no warm-up. What was lost before it is counted by copies.
std::uint64_t words_lost(const scenario::Run& run, models::StreamIndex stream, const results::StreamResult& state) {
  if (run.resolved().scenario.warm_up == sim::Duration()) return state.lost;
  const models::Stream& all = run.network().traffic().stream(stream);
  return all.dropped_in_all() - all.dropped[static_cast<std::size_t>(models::DropReason::duplicate)];
}

void look_at_words(const scenario::Run& run, const results::RunResult& result, std::vector<Violation>& found) {
  for (const scenario::ResolvedProgram& program : run.resolved().programs)
    for (const scenario::ResolvedMember& each : program.participants()) {
      const results::StreamResult& state = result.streams[each.state.value];
      if (const std::uint64_t lost = words_lost(run, each.state, state); lost > 0)
        found.push_back(
            {Assumption::no_loss, std::to_string(lost) + " of " + state.name + " were lost" + with_seed(result)});
    }
}

void look_at_changes(const scenario::Run& run, const results::RunResult& result, std::vector<Violation>& found) {
  for (std::size_t p = 0; p < run.resolved().programs.size(); ++p) {
    const scenario::ResolvedProgram& program = run.resolved().programs[p];
    if (program.description->publish != scenario::Publish::on_change) continue;
    for (std::size_t participant = 0; participant < program.participant_names.size(); ++participant) {
      std::vector<sim::TrueTime> changes;
      for (const scenario::StateRecord& record : run.monitor(p).history())
        if (record.participant == participant) changes.push_back(record.time);
      for (std::size_t i = most_changes_in_a_cycle; i < changes.size(); ++i)
        if (changes[i] - changes[i - most_changes_in_a_cycle] < program.description->cycle)
          found.push_back({Assumption::program_publishes, program.participant_names[participant] +
                                                              " changes more often in a cycle at " +
                                                              to_text(changes[i].since_start()) + with_seed(result)});
    }
  }
}

std::string exceeded(const std::string& what, sim::Duration seen, sim::Duration bound) {
  return what + ": a run took " + to_text(seen) + ", the bound is " + to_text(bound);
}

std::string contradiction_of_streams(const scenario::Resolved& resolved, const analysis::Bounds& bounds,
                                     const results::RunResult& result) {
  for (const analysis::StreamBound& bound : bounds.streams) {
    if (bound.index.value >= result.streams.size() ||
        !bounds.ledger.objection(bound.assumptions, resolved.scenario.warm_up).empty())
      continue;
    const results::StreamResult& stream = result.streams[bound.index.value];
    if (bound.latency && stream.latency && stream.latency->max > *bound.latency)
      return exceeded("latency of " + bound.name, stream.latency->max, *bound.latency);
    if (bound.latency && stream.latency && stream.latency->min < bound.least)
      return exceeded("fastest frame of " + bound.name, stream.latency->min, bound.least);
    if (bound.reaches_all && stream.lost > 0)
      return bound.name + ": a run lost " + std::to_string(stream.lost) + " frames, though nothing can be lost";
  }
  return {};
}

std::string contradiction_of_requirements(const analysis::Bounds& bounds, const results::RunResult& result) {
  for (const results::RequirementResult& seen : result.requirements) {
    if (seen.kind != results::RequirementKind::reaction || !seen.measured ||
        *seen.requirement >= bounds.requirements.size())
      continue;  // nobody asked for bounds
    const analysis::RequirementBound& bound = bounds.requirements[*seen.requirement];
    if (bound.duration && *seen.measured > *bound.duration &&
        bounds.ledger.objection(bound.assumptions, seen.from).empty())
      return exceeded(seen.text, *seen.measured, *bound.duration);
  }
  return {};
}

}  // namespace

std::vector<Violation> violations_in(const scenario::Run& run, const results::RunResult& result) {
  std::vector<Violation> found;
  look_at_clocks(run, result, found);
  look_at_words(run, result, found);
  look_at_changes(run, result, found);
  return found;
}

std::string contradiction_in(const scenario::Resolved& resolved, const analysis::Bounds& bounds,
                             const results::RunResult& result) {
  std::string found = contradiction_of_streams(resolved, bounds, result);
  return found.empty() ? contradiction_of_requirements(bounds, result) : found;
}

}  // namespace takt::verify
