// SPDX-License-Identifier: Apache-2.0
#include "synthesis/slack.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "json/node.hpp"
#include "json/quantity.hpp"
#include "models/ethernet/sizes.hpp"
#include "scenario/gates/layout.hpp"
#include "schedule_check/check.hpp"

namespace takt::synthesis {
namespace {

using scenario::Resolved;
using scenario::Scenario;
using sim::Duration;

constexpr Duration ns = Duration::from_ps(1'000);
constexpr Duration greatest = Duration::from_ps(1'000'000'000'000);  // as the table allows

/// The greatest margin that fits, to the ns, if `good` does: steps that double, then halves of the last one.
Duration greatest_margin(Duration good, const std::function<bool(Duration)>& fits) {
  Duration step = ns;
  while (good + step <= greatest && fits(good + step)) {
    good += step;
    step = step * 2;
  }
  for (std::int64_t half = step.ps() / 2; half >= ns.ps(); half /= 2)
    if (good + Duration::from_ps(half) <= greatest && fits(good + Duration::from_ps(half)))
      good += Duration::from_ps(half);
  return good;
}

/// Longest time of the cycle in which no scheduled class is open and the others are; all of it if nothing is closed.
Duration longest_for_others(const scenario::GateList& list, models::GateStates scheduled) {
  Duration most, now;
  for (int round = 0; round < 2; ++round)  // an interval may go over the end
    for (const scenario::GateList::Entry& entry : list.entries) {
      now = (entry.open & static_cast<models::GateStates>(~scheduled)) != 0 ? now + entry.interval : Duration();
      most = std::max(most, now);
    }
  return most;
}

std::string too_little_time(const scenario::GateProblem& problem, const scenario::GateSolution& schedule) {
  std::vector<models::GateStates> scheduled(problem.ports.size(), 0);
  for (const scenario::ScheduledStream& stream : problem.streams)
    for (const scenario::ScheduledHop& hop : stream.hops)
      scheduled[hop.port] = static_cast<models::GateStates>(scheduled[hop.port] | 1u << hop.traffic_class);
  for (std::size_t p = 0; p < problem.ports.size(); ++p) {
    if (schedule.lists[p].entries.empty()) continue;
    const Duration needed = problem.ports[p].gap *
                            static_cast<std::int64_t>(models::wire_length(problem.ports[p].longest_frame).count) /
                            models::inter_packet_gap.count;
    if (longest_for_others(schedule.lists[p], scheduled[p]) < needed)
      return fmt::format("no time is left for a frame of another class at {}", json::quote(problem.ports[p].name));
  }
  return {};
}

}  // namespace

std::string why_not_with(Duration margin, const scenario::GatePlan& plan, const Scenario& scenario) {
  scenario::GateProblem problem = plan.problem;
  problem.margin = margin;
  const scenario::GateLayout layout = scenario::lay_out_gates(problem);
  // First what no other offsets would cure.
  for (std::size_t s = 0; s < problem.streams.size(); ++s) {
    const scenario::ScheduledStream& stream = problem.streams[s];
    for (std::size_t h = 0; h < stream.hops.size(); ++h)
      for (const scenario::Requirement& requirement : scenario.require)
        if (requirement.stream == stream.name && requirement.latency &&
            layout.schedule.windows[s][h].close + stream.hops[h].behind - stream.release >
                requirement.latency->greatest())
          return fmt::format("{} takes longer than {}", json::quote(stream.name),
                             json::to_text(requirement.latency->greatest()));
  }
  if (!layout.conflicts.empty()) {
    const scenario::GateConflict& first = layout.conflicts.front();
    if (first.kind == scenario::GateConflict::Kind::overlap)
      return fmt::format("windows of {} and {} overlap at {}", json::quote(problem.streams[first.first].name),
                         json::quote(problem.streams[first.second].name), json::quote(problem.ports[first.port].name));
    return fmt::format("there is no gate list for {}", json::quote(problem.ports[first.port].name));
  }
  if (std::string little = too_little_time(problem, layout.schedule); !little.empty()) return little;
  const std::vector<std::string> wrong = schedule_check::check(problem, layout.schedule, 1);
  return wrong.empty() ? std::string() : wrong.front();
}

namespace {

/// The scenario as it was scheduled, with other margins.
Scenario with_margin(const Resolved& resolved, const Scenario& asked, Duration margin) {
  Scenario made = resolved.scenario;
  made.gates = asked.gates;
  made.gates->margin = json::OrAuto<Duration>(margin);
  return made;
}

Slack slack_of(const Resolved& resolved, const Scenario& asked, const SlackQuestions& questions) {
  const auto why_not = [&](Duration margin) {
    std::string why = why_not_with(margin, *resolved.gates, resolved.scenario);
    if (!why.empty()) return why;
    const auto made = questions.at_these_times(with_margin(resolved, asked, margin));
    return made ? questions.breaks(*made) : std::string("devices take no list with it");
  };
  Slack slack;
  slack.margin =
      greatest_margin(resolved.gates->problem.margin, [&](Duration margin) { return why_not(margin).empty(); });
  slack.with_more = why_not(slack.margin + ns);
  return slack;
}

}  // namespace

std::unique_ptr<Resolved> with_most_slack(std::unique_ptr<Resolved> resolved, const Scenario& asked,
                                          const SlackQuestions& questions, const std::function<bool()>& stop,
                                          Slack& slack) {
  slack = slack_of(*resolved, asked, questions);
  // Other offsets may do better.
  greatest_margin(slack.margin, [&](Duration margin) {
    if (stop()) return false;
    Scenario wider = asked;
    wider.gates->margin = json::OrAuto<Duration>(margin);
    auto made = questions.at_other_times(wider);
    if (!made || !why_not_with(margin, *made->gates, made->scenario).empty() || !questions.breaks(*made).empty())
      return false;
    resolved = std::move(made);
    return true;
  });
  slack = slack_of(*resolved, asked, questions);
  // The same times with windows as wide as they may be.
  auto made = questions.at_these_times(with_margin(*resolved, asked, slack.margin));
  return made ? std::move(made) : std::move(resolved);
}

}  // namespace takt::synthesis
