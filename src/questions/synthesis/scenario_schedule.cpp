// SPDX-License-Identifier: Apache-2.0
#include "synthesis/scenario_schedule.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "analysis/bounds.hpp"
#include "evaluation/evaluate.hpp"
#include "schedule_instances/proof.hpp"
#include "json/node.hpp"
#include "json/quantity.hpp"
#include "scenario/gates/beginning.hpp"
#include "scenario/gates/crossings.hpp"
#include "scenario/resolve/gate_limits.hpp"
#include "scenario/resolve.hpp"
#include "scenario/run/run.hpp"
#include "schedule/refute.hpp"
#include "schedule_check/check.hpp"
#include "schedule_check/instance_check.hpp"
#include "synthesis/instance_of_scenario.hpp"
#include "synthesis/open_routes.hpp"
#include "synthesis/placements.hpp"

namespace takt::synthesis {
namespace {

using scenario::Resolved;
using scenario::Scenario;
using sim::Duration;
using Verdict = schedule::Decision::Verdict;

/// The resolver's answer; null if it finds no offsets, or anything else is wrong. What devices cannot do is noted in
/// `why`.
std::unique_ptr<Resolved> resolve_quietly(const Scenario& scenario, std::string& why) {
  json::Diagnostics unheard;
  auto resolved = scenario::resolve(scenario, unheard);
  for (const json::Diagnostic& each : unheard.kept())
    if (each.message == scenario::beyond_the_device || each.message == scenario::too_long_a_cycle)
      why = each.details.found;
  return unheard.has_errors() || !resolved || !resolved->gates ? nullptr : std::move(resolved);
}

std::vector<std::string> path_of(const schedule::Problem& problem, const schedule::Placement& placement) {
  std::vector<std::string> names{problem.nodes[problem.links[placement.route.front()].from].name};
  for (const schedule::LinkIndex l : placement.route) names.push_back(problem.nodes[problem.links[l].to].name);
  return names;
}

std::size_t longest_list(const Resolved& resolved) {
  std::size_t most = 0;
  for (const scenario::GateList& list : resolved.gates->schedule.lists) most = std::max(most, list.entries.size());
  return most;
}

/// From the release to the arrival at the last listener, with the window's margin: what the schedule promises.
Duration planned_latency(const scenario::GatePlan& plan, std::size_t s) {
  const scenario::ScheduledStream& stream = plan.problem.streams[s];
  Duration most;
  for (std::size_t h = 0; h < stream.hops.size(); ++h)
    most = std::max(most, plan.schedule.windows[s][h].close + stream.hops[h].behind - stream.release);
  return most;
}

/// Whether a link on the way of the stream, or a node, is down from the start on and stays so: the resolver lays ways
/// without regard to that.
bool uses_failed_link(const Resolved& resolved, const std::string& name) {
  const auto index =
      std::ranges::find(resolved.plan.streams, name, &models::StreamPlan::name) - resolved.plan.streams.begin();
  const auto is_on_way = [&](const std::string& a, const std::string& b) {
    for (const scenario::Path& path : resolved.streams[static_cast<std::size_t>(index)].paths)
      for (std::size_t i = 0; i + 1 < path.size(); ++i) {
        const std::string &from = resolved.topology.nodes[path[i]].name,
                          &to = resolved.topology.nodes[path[i + 1]].name;
        if ((from == a && (to == b || b.empty())) || (to == a && (from == b || b.empty()))) return true;
      }
    return false;
  };
  return std::ranges::any_of(resolved.scenario.faults, [&](const scenario::Fault& fault) {
    if (const auto* const link = std::get_if<scenario::LinkDown>(&fault))
      return link->at == Duration() && is_on_way(link->link.front(), link->link.back());
    if (const auto* const crash = std::get_if<scenario::Crash>(&fault))
      return crash->at == Duration() && is_on_way(crash->node, "");
    return false;
  });
}

/// A run of the scenario, in which what is sent before the lists are in force does not count.
results::RunResult run_of(Resolved& resolved) {
  const Duration warm_up = resolved.scenario.warm_up;
  if (resolved.gates->begins > Duration()) {
    Duration longest;
    for (const scenario::ScheduledStream& each : resolved.gates->problem.streams)
      longest = std::max(longest, each.period);
    const Duration from = resolved.gates->begins + longest;
    if (from < resolved.scenario.duration) resolved.scenario.warm_up = std::max(warm_up, from);
  }
  scenario::Run run(resolved);
  run.advance();
  results::RunResult result = evaluation::evaluate(run, false);
  resolved.scenario.warm_up = warm_up;
  return result;
}

/// Requirements that the run breaks, beside what is bounded of those of streams.
void judge_requirements(ScenarioSchedule& answer, const results::RunResult& result) {
  const bool has_clocks = scenario::clocks_synchronised_from(answer.resolved->scenario).has_value();
  for (const results::RequirementResult& seen : result.requirements) {
    const auto known = std::ranges::find_if(
        answer.requirements, [&](const StreamRequirement& each) { return seen.requirement == each.requirement; });
    if (known != answer.requirements.end()) {
      known->simulated = seen.measured;
      if (!has_clocks && known->bound && seen.measured && *seen.measured > *known->bound)
        answer.wrong.push_back(fmt::format("bound: {} is {} in a run, and at most {} is bounded", known->text,
                                           json::to_text(*seen.measured), json::to_text(*known->bound)));
    }
    if (seen.verdict != results::Verdict::fail) continue;
    const std::string in_the_run = seen.measured
                                       ? json::to_text(*seen.measured) + " in its run"
                                       : "broken in its run" + (seen.remark.empty() ? "" : " (" + seen.remark + ")");
    if (known != answer.requirements.end()) {
      known->state = StreamRequirement::State::broken;
      known->reason = in_the_run;
    }
    if (answer.verdict == Verdict::scheduled) answer.how = seen.text + ": " + in_the_run;
    answer.verdict = Verdict::undecided;
  }
  const std::string broken = first_broken(answer.requirements);
  if (answer.verdict != Verdict::scheduled || broken.empty()) return;
  answer.how = broken;
  answer.verdict = Verdict::undecided;
}

void judge(ScenarioSchedule& answer) {
  Resolved& resolved = *answer.resolved;
  answer.wrong = schedule_check::check(resolved.gates->problem, resolved.gates->schedule);
  for (std::string& each : answer.wrong) each = "checker: " + each;
  const results::RunResult result = run_of(resolved);
  const analysis::Bounds bounds = analysis::bound(resolved);
  answer.requirements = stream_requirements(resolved, bounds);
  judge_requirements(answer, result);
  const bool has_clocks = scenario::clocks_synchronised_from(resolved.scenario).has_value();
  for (std::size_t s = 0; s < resolved.gates->problem.streams.size(); ++s) {
    const scenario::ScheduledStream& stream = resolved.gates->problem.streams[s];
    JudgedStream judged{stream.name, planned_latency(*resolved.gates, s), 0, {}, {}};
    for (const results::StreamResult& each : result.streams) {
      if (each.name != stream.name) continue;
      judged.delivered = each.delivered;
      if (each.latency) judged.simulated = each.latency->max;
      if (each.lost != 0 && uses_failed_link(resolved, stream.name)) {
        answer.how =
            json::quote(stream.name) + " goes over what is down from the start on; a \"path\" of its own goes round it";
        answer.verdict = Verdict::undecided;
      } else if (each.lost != 0)
        answer.wrong.push_back(fmt::format("simulator: {} loses {} frames", stream.name, each.lost));
    }
    for (const analysis::StreamBound& each : bounds.streams)
      if (each.name == stream.name) judged.bound = each.latency;
    // Of clocks a run shows only what they did in it: where they are worse, or lists begin too early, a frame misses
    // its window, and as a window has room for one frame what stands before it stays for ever.
    const bool is_late = judged.delivered > 0 && (judged.simulated >= judged.planned + stream.period ||
                                                  (judged.bound && judged.simulated > *judged.bound));
    if (is_late && has_clocks) {
      answer.how = fmt::format(
          "{} takes {} in its run, and {} is planned: one of its frames has missed its window, and those behind it "
          "wait for the next one each",
          json::quote(stream.name), json::to_text(judged.simulated), json::to_text(judged.planned));
      answer.verdict = Verdict::undecided;
      continue;
    }
    if (judged.delivered > 0 && judged.bound && judged.simulated > *judged.bound)
      answer.wrong.push_back(fmt::format("bound: {} takes {} ps, and at most {} ps are bounded", stream.name,
                                         judged.simulated.ps(), judged.bound->ps()));
    // A frame that misses its window waits for the next one.
    if (judged.delivered > 0 && judged.simulated >= judged.planned + stream.period)
      answer.wrong.push_back(fmt::format("simulator: {} misses its windows", stream.name));
    answer.streams.push_back(std::move(judged));
  }
}

/// No device has more entries than that.
Scenario with_entries(Scenario scenario, std::uint32_t entries) {
  if (entries >= scenario::most_gate_entries) return scenario;
  const auto limit = [entries](std::optional<scenario::GateLimits>& limits) {
    if (!limits) limits.emplace();
    limits->entries = std::min(limits->entries.value_or(entries), entries);
  };
  for (auto& [name, node] : scenario.network.nodes) limit(scenario::ports_of(node).gate_limits);
  for (scenario::Generator& generator : scenario.network.generate) {
    limit(generator.gate_limits);
    limit(generator.host_gate_limits);
  }
  return scenario;
}

/// Streams that may begin when it suits begin when clocks are synchronised, whole periods later. Null if that cannot
/// be.
std::unique_ptr<Resolved> begin_later(std::unique_ptr<Resolved> resolved, const Scenario& asked, Duration from,
                                      std::string& why) {
  Scenario later = resolved->scenario;
  later.gates = asked.gates;
  later.gates->margin = json::OrAuto<Duration>(resolved->gates->problem.margin);
  from = std::max(from, resolved->gates->begins);
  for (scenario::Stream& stream : later.streams) {
    const auto written = std::ranges::find(asked.streams, stream.name, &scenario::Stream::name);
    if (written == asked.streams.end() || !written->offset || !written->offset->is_auto || !stream.every ||
        !stream.offset)
      continue;
    if (stream.offset->value < from)
      stream.offset->value +=
          *stream.every * ((from - stream.offset->value + *stream.every - Duration::from_ps(1)) / *stream.every);
  }
  return resolve_quietly(later, why);
}

/// Streams whose ways may be other ones: those that say so, and with `may_route` all scheduled ones that say neither
/// path nor offset.
OpenRoutes open_ways(const Scenario& asked, const Resolved& resolved, OpenRoutes open, bool may_route) {
  if (!may_route) return open;
  for (const scenario::ScheduledStream& each : resolved.gates->problem.streams) {
    const auto written = std::ranges::find(asked.streams, each.name, &scenario::Stream::name);
    if (written != asked.streams.end() && !written->path && written->offset && written->offset->is_auto &&
        written->to.names.size() == 1)
      open.insert(each.name);
  }
  return open;
}

/// A schedule that keeps what is required of all streams, that of `resolved` or another one; null if none does, and
/// then `answer` says how close they come.
std::unique_ptr<Resolved> keep_requirements(std::unique_ptr<Resolved> resolved, const Scenario& asked,
                                            const OpenRoutes& open, const ScenarioOptions& options,
                                            ScenarioSchedule& answer, const char*& how) {
  if (!requires_of_streams(*resolved)) return resolved;
  std::string unsaid;
  PlacementOptions places{open_ways(asked, *resolved, open, options.may_route), options.search.seed,
                          options.search.stop,
                          [&unsaid](const Scenario& scenario) { return resolve_quietly(scenario, unsaid); }};
  Placed placed = place_for_requirements(std::move(resolved), asked, places);
  const Shortfall shortfall = shortfall_of(placed.best.requirements);
  const bool is_closest = answer.placements == 0 || shortfall < shortfall_of(answer.requirements);
  answer.placements += placed.tried;
  if (is_closest) {
    answer.requirements = placed.best.requirements;
    answer.placement = placed.best.how;
  }
  if (shortfall.broken == 0) {
    if (placed.best.has_other_ways) how = "searched paths";
    return std::move(placed.best.resolved);
  }
  answer.how = fmt::format("{} in the closest of {} schedules ({})", first_broken(answer.requirements),
                           answer.placements, answer.placement);
  return nullptr;
}

/// Wider margins than devices take are none, and none takes so much of the other traffic that what is required of it
/// breaks.
SlackQuestions slack_questions(const Scenario& asked, const Resolved& resolved, const OpenRoutes& open,
                               const ScenarioOptions& options) {
  const OpenRoutes ways = open_ways(asked, resolved, open, options.may_route);
  const auto resolve = [](const Scenario& scenario) {
    std::string unsaid;
    return resolve_quietly(scenario, unsaid);
  };
  SlackQuestions questions;
  questions.at_these_times = resolve;
  questions.breaks = [](const Resolved& made) {
    return requires_of_streams(made) ? first_broken(stream_requirements(made, analysis::bound(made))) : std::string();
  };
  questions.at_other_times = [=, &options](const Scenario& scenario) {
    auto made = resolve(scenario);
    if (!made || !requires_of_streams(*made)) return made;
    Placed placed =
        place_for_requirements(std::move(made), scenario, {ways, options.search.seed, options.search.stop, resolve});
    return shortfall_of(placed.best.requirements).broken == 0 ? std::move(placed.best.resolved) : nullptr;
  };
  return questions;
}

/// True if it is answered: scheduled, or lists too long for the devices.
bool take(ScenarioSchedule& answer, const Scenario& asked, const OpenRoutes& open, const ScenarioOptions& options,
          const char* how) {
  auto resolved = resolve_quietly(asked, answer.how);
  if (!resolved) return false;
  if (longest_list(*resolved) <= options.entries)
    resolved = keep_requirements(std::move(resolved), asked, open, options, answer, how);
  if (!resolved) return false;
  if (options.wants_slack) {
    const SlackQuestions questions = slack_questions(asked, *resolved, open, options);
    resolved = with_most_slack(std::move(resolved), asked, questions, options.search.stop, answer.slack.emplace());
  }
  if (answer.clock_margin) resolved = begin_later(std::move(resolved), asked, answer.clock_margin->from, answer.how);
  if (!resolved) return false;
  answer.most_entries = longest_list(*resolved);
  if (answer.most_entries > options.entries) {
    answer.how = fmt::format("a gate list of {} entries, and {} are allowed", answer.most_entries, options.entries);
    return false;
  }
  answer.how = how;
  answer.verdict = Verdict::scheduled;
  answer.resolved = std::move(resolved);
  judge(answer);
  if (answer.verdict != Verdict::scheduled) {
    answer.resolved.reset();
    return true;
  }
  if (answer.slack && answer.resolved->gates->problem.margin != answer.slack->margin)
    answer.wrong.push_back("slack: windows are not as wide as the clock error that they are said to survive");
  if (answer.slack && answer.slack->with_more.empty())
    answer.wrong.push_back("slack: clocks may differ by more than is said");
  return true;
}

/// What keeps its place though it could have another one is in nobody's proof: without it there must be no schedule.
schedule::Decision decide_with_what_stays(const ScenarioInstance& instance, const schedule::SearchOptions& search,
                                          ScenarioSchedule& answer) {
  answer.instance = instance.problem;
  if (instance.cuts_through) {
    schedule::SearchOptions unproved = search;
    unproved.judge = [](const schedule::Problem&, const schedule::Certificate&) -> std::string {
      return "it counts store and forward, and frames are cut through";
    };
    return schedule::decide(instance.problem, unproved);
  }
  if (std::ranges::find(instance.is_given, false) == instance.is_given.end())
    return schedule_check::decide_judged(instance.problem, search);
  if (ScenarioInstance given = given_streams(instance); !given.problem.streams.empty()) {
    schedule::SearchOptions quick = search;
    quick.attempts = std::min<std::uint32_t>(search.attempts, 64);
    schedule::Decision decision = schedule_check::decide_judged(given.problem, quick);
    if (decision.verdict == Verdict::infeasible) {
      answer.instance = std::move(given.problem);
      return decision;
    }
  }
  schedule::SearchOptions whole = search;
  whole.judge = [&instance](const schedule::Problem& problem, const schedule::Certificate& certificate) {
    const auto is_elsewhere = [&](schedule::StreamIndex s) { return !instance.is_given[s]; };
    const bool rests = std::ranges::any_of(certificate.streams, is_elsewhere) ||
                       std::ranges::any_of(certificate.jobs, [&](const auto& job) { return is_elsewhere(job.first); });
    return rests ? "it rests on what could be elsewhere" : schedule_check::why_not_proved(problem, certificate);
  };
  return schedule::decide(instance.problem, whole);
}

/// Whole ns, if delays are.
Duration offset_of(const ScenarioInstance& instance, std::size_t s, const schedule::Solution& solution) {
  const schedule::Ps period = instance.problem.streams[s].period;
  return Duration::from_ps(scenario::modulo(solution.streams[s]->starts.front().front() - instance.lags[s], period) /
                           1'000 * 1'000);
}

}  // namespace

std::optional<ScenarioSchedule> schedule_scenario(const Scenario& asked, const ScenarioOptions& options,
                                                  json::Diagnostics& diagnostics) {
  Scenario wanted = with_entries(asked, options.entries);
  if (!wanted.gates || wanted.gates->plan != scenario::GatePlanning::automatic) {
    diagnostics.error(wanted.where.at("gates"), "nothing to schedule",
                      {"no automatic gates",
                       "\"gates\": {\"plan\": \"auto\", \"classes\": [...]}, and \"offset\": \"auto\" where a stream "
                       "may begin when it suits"});
    return std::nullopt;
  }
  ScenarioSchedule answer;
  if (has_margin_to_measure(wanted)) {
    answer.clock_margin = options.clock_margin ? options.clock_margin : measure_clock_margin(wanted, diagnostics);
    if (!answer.clock_margin) return std::nullopt;
    wanted = with_clock_margin(std::move(wanted), *answer.clock_margin);
  }
  OpenRoutes open = write_shortest_paths(wanted, diagnostics);
  if (diagnostics.has_errors()) return std::nullopt;
  if (!options.may_route_open) open.clear();
  if (take(answer, wanted, open, options, "given paths")) return answer;
  // Is anything else wrong than that there is no schedule? Without gates it would be, too.
  Scenario bare = wanted;
  bare.gates.reset();
  bare.allow_overload = true;  // of the paths that the file says; others may do
  auto resolved = scenario::resolve(bare, diagnostics);
  if (!resolved || diagnostics.has_errors()) return std::nullopt;
  std::string why_not;
  auto instance = instance_of(*resolved, wanted, open, diagnostics, why_not);
  if (diagnostics.has_errors()) return std::nullopt;
  if (!instance) {
    if (answer.how.empty()) answer.how = "no offsets found, and no search for paths: " + why_not;
    return answer;
  }
  schedule::Problem& problem = instance->problem;
  if (!options.may_route) {
    // The ways of the scenario are all that there are.
    for (std::size_t s = 0; s < problem.streams.size(); ++s) {
      if (problem.streams[s].route || open.contains(problem.streams[s].name)) continue;
      std::vector<schedule::LinkIndex> route;
      for (const scenario::ResolvedStream& each : resolved->streams)
        if (resolved->plan.streams[each.index.value].name == problem.streams[s].name)
          for (std::size_t i = 0; i + 1 < each.paths.front().size(); ++i)
            for (schedule::LinkIndex l = 0; l < problem.links.size(); ++l)
              if (problem.links[l].from == each.paths.front()[i] && problem.links[l].to == each.paths.front()[i + 1] &&
                  (route.empty() || route.back() != l)) {
                route.push_back(l);
                break;
              }
      problem.streams[s].route = std::move(route);
    }
  }
  // Ways that the scenario leaves open are searched for whatever becomes of the others, which have their routes by now.
  schedule::SearchOptions search = options.search;
  if (!open.empty()) search.routes = schedule::RouteChoice::search;
  schedule::Decision decision = decide_with_what_stays(*instance, search, answer);
  answer.verdict = decision.verdict;
  answer.certificate = decision.certificate;
  answer.left_over = decision.found.left_over;
  if (decision.verdict == Verdict::infeasible) {
    answer.how = schedule_instances::kind_of(*answer.certificate);
    answer.proof = schedule_instances::proof_of(*answer.instance, *answer.certificate);
    answer.left_over.clear();  // some partial schedule is no part of a proof
    answer.requirements.clear();
    answer.placements = 0;
    answer.placement.clear();
  }
  if (decision.verdict != Verdict::scheduled) return answer;
  answer.verdict = Verdict::undecided;
  Scenario routed = wanted;
  for (std::size_t s = 0; s < problem.streams.size(); ++s)
    if (instance->streams[s] && !problem.streams[s].route)
      routed.streams[*instance->streams[s]].path = path_of(problem, *decision.found.solution.streams[s]);
  // What was tried already comes to the same.
  if (routed.streams != wanted.streams && take(answer, routed, open, options, "searched paths")) return answer;
  // Starts that the search found: whole ns, if delays are.
  for (std::size_t s = 0; s < problem.streams.size(); ++s) {
    if (!instance->streams[s]) continue;
    auto& written = routed.streams[*instance->streams[s]];
    if (written.offset && written.offset->is_auto)
      written.offset = json::OrAuto<Duration>(offset_of(*instance, s, decision.found.solution));
  }
  if (take(answer, routed, open, options, "searched paths and offsets")) return answer;
  if (answer.how.empty()) answer.how = "ways were found for which no offsets in whole ns are";
  return answer;
}

}  // namespace takt::synthesis
