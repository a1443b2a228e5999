#include "synthesis/scenario_schedule.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "analysis/bounds.hpp"
#include "evaluation/evaluate.hpp"
#include "scenario/resolve/gate_limits.hpp"
#include "scenario/resolve/resolve.hpp"
#include "scenario/run/run.hpp"
#include "schedule/refute.hpp"
#include "schedule_check/check.hpp"
#include "schedule_check/instance_check.hpp"
#include "synthesis/instance_of_scenario.hpp"

namespace takt::synthesis {
namespace {

using scenario::Resolved;
using scenario::Scenario;
using sim::Duration;
using Verdict = schedule::Decision::Verdict;

/// The resolver's answer; null if it finds no offsets, or anything else is wrong. What devices cannot do is noted in `why`.
std::unique_ptr<Resolved> resolve_quietly(const Scenario& scenario, std::string& why) {
  json::Diagnostics unheard;
  auto resolved = scenario::resolve(scenario, unheard);
  for (const json::Diagnostic& each : unheard.kept())
    if (each.message == scenario::beyond_the_device) why = each.details.found;
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
  for (std::size_t h = 0; h < stream.hops.size(); ++h) most = std::max(most, plan.schedule.windows[s][h].close + stream.hops[h].behind - stream.release);
  return most;
}

void judge(ScenarioSchedule& answer) {
  const Resolved& resolved = *answer.resolved;
  answer.wrong = schedule_check::check(resolved.gates->problem, resolved.gates->schedule);
  for (std::string& each : answer.wrong) each = "checker: " + each;
  scenario::Run run(resolved);
  run.advance();
  const results::RunResult result = evaluation::evaluate(run, false);
  const analysis::Bounds bounds = analysis::bound(resolved);
  for (std::size_t s = 0; s < resolved.gates->problem.streams.size(); ++s) {
    const scenario::ScheduledStream& stream = resolved.gates->problem.streams[s];
    JudgedStream judged{stream.name, planned_latency(*resolved.gates, s), 0, {}, {}};
    for (const results::StreamResult& each : result.streams) {
      if (each.name != stream.name) continue;
      judged.delivered = each.delivered;
      if (each.latency) judged.simulated = each.latency->max;
      if (each.lost != 0) answer.wrong.push_back(fmt::format("simulator: {} loses {} frames", stream.name, each.lost));
    }
    for (const analysis::StreamBound& each : bounds.streams)
      if (each.name == stream.name) judged.bound = each.latency;
    if (judged.delivered > 0 && judged.bound && judged.simulated > *judged.bound) answer.wrong.push_back(fmt::format("bound: {} takes {} ps, and at most {} ps are bounded", stream.name, judged.simulated.ps(), judged.bound->ps()));
    // A frame that misses its window waits for the next one.
    if (judged.delivered > 0 && judged.simulated >= judged.planned + stream.period) answer.wrong.push_back(fmt::format("simulator: {} misses its windows", stream.name));
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
  for (scenario::Generator& generator : scenario.network.generate) limit(generator.gate_limits);
  return scenario;
}

/// True if it is answered: scheduled, or lists too long for the devices.
bool take(ScenarioSchedule& answer, const Scenario& asked, const ScenarioOptions& options, const char* how) {
  auto resolved = resolve_quietly(asked, answer.how);
  if (!resolved) return false;
  std::string unsaid;   // wider margins than devices take are none
  const auto resolve = [&unsaid](const Scenario& scenario) { return resolve_quietly(scenario, unsaid); };
  if (options.wants_slack) resolved = with_most_slack(std::move(resolved), asked, resolve, options.search.stop, answer.slack.emplace());
  answer.most_entries = longest_list(*resolved);
  if (answer.most_entries > options.entries) {
    answer.how = fmt::format("a gate list of {} entries, and {} are allowed", answer.most_entries, options.entries);
    return false;
  }
  answer.how = how;
  answer.verdict = Verdict::scheduled;
  answer.resolved = std::move(resolved);
  judge(answer);
  if (answer.slack && answer.resolved->gates->problem.margin != answer.slack->margin) answer.wrong.push_back("slack: windows are not as wide as the clock error that they are said to survive");
  if (answer.slack && answer.slack->with_more.empty()) answer.wrong.push_back("slack: clocks may differ by more than is said");
  return true;
}

}  // namespace

std::optional<ScenarioSchedule> schedule_scenario(const Scenario& asked, const ScenarioOptions& options, json::Diagnostics& diagnostics) {
  const Scenario wanted = with_entries(asked, options.entries);
  if (!wanted.gates || wanted.gates->plan != scenario::GatePlanning::automatic) {
    diagnostics.error(wanted.where.at("gates"), "nothing to schedule", {"no automatic gates", "\"gates\": {\"plan\": \"auto\", \"classes\": [...]}, and \"offset\": \"auto\" where a stream may begin when it suits"});
    return std::nullopt;
  }
  ScenarioSchedule answer;
  if (take(answer, wanted, options, "given paths")) return answer;
  // Is anything else wrong than that there is no schedule? Without gates it would be, too.
  Scenario bare = wanted;
  bare.gates.reset();
  bare.allow_overload = true;   // of the paths that the file says; others may do
  auto resolved = scenario::resolve(bare, diagnostics);
  if (!resolved || diagnostics.has_errors()) return std::nullopt;
  std::string why_not;
  auto instance = instance_of(*resolved, wanted, diagnostics, why_not);
  if (diagnostics.has_errors()) return std::nullopt;
  if (!instance) {
    if (answer.how.empty()) answer.how = "no offsets found, and no search for paths: " + why_not;
    return answer;
  }
  schedule::Problem& problem = instance->problem;
  if (!options.may_route) {
    // The ways of the scenario are all that there are.
    for (std::size_t s = 0; s < problem.streams.size(); ++s) {
      if (problem.streams[s].route) continue;
      std::vector<schedule::LinkIndex> route;
      for (const scenario::ResolvedStream& each : resolved->streams)
        if (resolved->plan.streams[each.index.value].name == problem.streams[s].name)
          for (std::size_t i = 0; i + 1 < each.paths.front().size(); ++i)
            for (schedule::LinkIndex l = 0; l < problem.links.size(); ++l)
              if (problem.links[l].from == each.paths.front()[i] && problem.links[l].to == each.paths.front()[i + 1] && (route.empty() || route.back() != l)) {
                route.push_back(l);
                break;
              }
      problem.streams[s].route = std::move(route);
    }
  }
  schedule::Decision decision = schedule::decide(problem, options.search);
  answer.verdict = decision.verdict;
  answer.certificate = decision.certificate;
  answer.left_over = decision.found.left_over;
  answer.instance = problem;
  if (decision.certificate)
    if (const std::string why = schedule_check::why_not_proved(problem, *decision.certificate); !why.empty()) answer.wrong.push_back("certificate: " + why);
  if (decision.verdict == Verdict::infeasible) answer.how.clear();
  if (decision.verdict != Verdict::scheduled) return answer;
  answer.verdict = Verdict::undecided;
  Scenario routed = wanted;
  for (std::size_t s = 0; s < problem.streams.size(); ++s)
    if (instance->streams[s] && !problem.streams[s].route) routed.streams[*instance->streams[s]].path = path_of(problem, *decision.found.solution.streams[s]);
  if (take(answer, routed, options, "searched paths")) return answer;
  // Starts that the search found: whole ns, if delays are.
  for (std::size_t s = 0; s < problem.streams.size(); ++s) {
    if (!instance->streams[s]) continue;
    auto& written = routed.streams[*instance->streams[s]];
    if (written.offset && written.offset->is_auto) written.offset = json::OrAuto<Duration>(Duration::from_ps(decision.found.solution.streams[s]->starts.front().front() / 1'000 * 1'000));
  }
  if (take(answer, routed, options, "searched paths and offsets")) return answer;
  if (answer.how.empty()) answer.how = "ways were found for which no offsets in whole ns are";
  return answer;
}

}  // namespace takt::synthesis
