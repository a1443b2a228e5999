// SPDX-License-Identifier: Apache-2.0
// takt schedule: routes, phases and gate lists that are found, or why there are none.
#include <fmt/format.h>

#include <chrono>
#include <cstdio>
#include <ctime>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "cli/commands.hpp"
#include "cli/companion.hpp"
#include "cli/places.hpp"
#include "cli/schedule_change.hpp"
#include "cli/schedule_scenario_change.hpp"
#include "cli/terminal.hpp"
#include "json/document.hpp"
#include "json/fields.hpp"
#include "json/quantity.hpp"
#include "output/result_folder.hpp"
#include "schedule/decide.hpp"
#include "schedule/gate_lists.hpp"
#include "schedule_check/instance_check.hpp"
#include "schedule_instances/instances.hpp"
#include "schedule_instances/report.hpp"
#include "schedule_instances/write.hpp"
#include "synthesis/report.hpp"

namespace takt::cli {
namespace {

using schedule::Decision;
using Clock = std::chrono::steady_clock;

struct ScheduleOptions {
  std::vector<std::string> files;
  std::string routes = "search";
  std::string objective = "feasible";
  std::optional<std::string> limit;
  std::optional<std::string> cpu_limit;
  std::uint64_t seed = 1;
  std::uint32_t jobs = 0;
  std::uint32_t entries = 1'000'000;
  bool gates = false;
  std::optional<std::string> out;
  std::optional<std::string> certificate;
  std::string format = "text";
  std::optional<std::string> to;
  ChangeOptions change;
  ScenarioChangeOptions scenario_change;
};

/// How long a search may take: by the clock on the wall, and of the processors.
struct Limits {
  std::optional<sim::Duration> wall;
  std::optional<sim::Duration> cpu;
};

std::chrono::nanoseconds used_of_processors() {
  timespec now{};
  ::clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return std::chrono::seconds(now.tv_sec) + std::chrono::nanoseconds(now.tv_nsec);
}

/// Counts from now on.
schedule::Stop stop_at(const Limits& limits) {
  const auto length = [](sim::Duration limit) { return std::chrono::nanoseconds(limit.ps() / 1'000); };
  return [wall = limits.wall ? std::optional(Clock::now() + length(*limits.wall)) : std::nullopt,
          cpu = limits.cpu ? std::optional(used_of_processors() + length(*limits.cpu)) : std::nullopt] {
    return (wall && Clock::now() > *wall) || (cpu && used_of_processors() > *cpu);
  };
}

/// Two kinds of mistakes: told as text, or as JSON where the output is JSON.
ExitStatus report_mistakes(const json::Diagnostics& diagnostics, const ScheduleOptions& options) {
  if (options.format == "json")
    std::fputs(json::pretty(diagnostics.to_json()).c_str(), stdout);
  else
    std::fputs(diagnostics.to_text().c_str(), stderr);
  return ExitStatus::bad_input;
}

/// A file of one instance, or in a folder ("DIR/") one for each.
std::string path_for(const std::string& out, const schedule::Problem& problem, const char* ending) {
  return out.ends_with('/') ? out + problem.name + ending : out;
}

bool write_file(const std::string& path, const std::string& text) {
  const std::string problem = output::write_file(path, text);
  if (!problem.empty()) std::fprintf(stderr, "takt: cannot write: %s\n", problem.c_str());
  return problem.empty();
}

schedule::SearchOptions search_options(const ScheduleOptions& options, const Limits& limits) {
  schedule::SearchOptions how;
  how.routes = options.routes == "search" ? schedule::RouteChoice::search : schedule::RouteChoice::shortest;
  how.seed = options.seed;
  how.jobs = options.jobs == 0 ? std::max(1u, std::thread::hardware_concurrency()) : options.jobs;
  how.attempts = 1'000'000;
  how.stop = stop_at(limits);
  return how;
}

schedule::Objective objective_of(const std::string& name) {
  if (name == "latency") return schedule::Objective::latency;
  if (name == "entries") return schedule::Objective::entries;
  return name == "slack" ? schedule::Objective::slack : schedule::Objective::feasible;
}

/// Whoever is wrong, takt must not say it. False: it was about to.
bool is_judged_right(const schedule::Problem& problem, const Decision& decision) {
  std::vector<std::string> wrong;
  if (decision.verdict == Decision::Verdict::scheduled) {
    schedule::Problem with_margin = problem;
    with_margin.model.margin = decision.margin;
    wrong = schedule_check::check(with_margin, decision.found.solution);
  }
  for (const std::string& each : decision.rejected)
    std::fprintf(stderr,
                 "takt: %s: a certificate is no proof (%s), and does not count; please report it with this instance\n",
                 problem.name.c_str(), each.c_str());
  for (const std::string& each : wrong)
    std::fprintf(stderr, "takt: %s is answered wrongly: %s\n", problem.name.c_str(), each.c_str());
  return wrong.empty();
}

ExitStatus schedule_instance(const schedule::Problem& problem, const ScheduleOptions& options, const Limits& limits,
                             json::Node& reports) {
  const std::clock_t begin = std::clock();
  Decision decision =
      schedule_check::decide_judged(problem, search_options(options, limits), objective_of(options.objective));
  std::optional<std::string> no_lists;
  if (options.gates && decision.verdict == Decision::Verdict::scheduled)
    no_lists = schedule::make_gate_lists(problem, decision.found.solution, {options.entries});
  const double took = static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC;
  if (!is_judged_right(problem, decision)) return ExitStatus::internal_error;
  const schedule_instances::ScheduleReport report = schedule_instances::report(problem, decision, no_lists);
  std::optional<std::string> solution, certificate;
  if (decision.verdict == Decision::Verdict::scheduled)
    solution = json::compact(schedule_instances::write_solution(problem, decision.found.solution)) + "\n";
  if (decision.certificate)
    certificate = json::compact(schedule_instances::write_certificate(problem, *decision.certificate)) + "\n";
  if (options.format == "json")
    reports.items.push_back(json::ShapeOf<schedule_instances::ScheduleReport>::write(report));
  if (options.format == "text")
    print(schedule_instances::text_of(report) + fmt::format("  in {:.3f} ms of the processor\n", took * 1e3));
  if (options.format == "neutral")
    std::fputs((solution ? *solution : certificate.value_or(std::string())).c_str(), stdout);
  if (options.out && solution && !write_file(path_for(*options.out, problem, ".solution.json"), *solution))
    return ExitStatus::internal_error;
  if (options.certificate && certificate &&
      !write_file(path_for(*options.certificate, problem, ".certificate.json"), *certificate))
    return ExitStatus::internal_error;
  if (decision.verdict == Decision::Verdict::infeasible) return ExitStatus::requirement_failed;
  return decision.verdict == Decision::Verdict::undecided || no_lists ? ExitStatus::undecided : ExitStatus::pass;
}

/// A scenario: what comes out is one, too.
ExitStatus schedule_scenario(const ScheduleOptions& options, const Limits& limits) {
  json::Diagnostics diagnostics;
  scenario::Scenario wanted;
  const auto document = json::parse_file(options.files.front(), diagnostics);
  if (!document || !json::decode(*document, wanted, diagnostics)) return report_mistakes(diagnostics, options);
  if (options.objective == "latency" || options.objective == "entries") {
    std::fprintf(stderr,
                 "takt: --objective %s: found a scenario, expected an instance; of a scenario feasible or slack\n",
                 options.objective.c_str());
    return ExitStatus::bad_input;
  }
  synthesis::ScenarioOptions how;
  how.may_route = options.routes == "search";
  how.may_route_open = options.routes != "shortest";
  how.entries = std::min<std::uint32_t>(options.entries, scenario::most_gate_entries);
  how.wants_slack = options.objective == "slack";
  // The limit is that of the search.
  if (synthesis::has_margin_to_measure(wanted)) {
    how.clock_margin = synthesis::measure_clock_margin(wanted, diagnostics);
    if (!how.clock_margin) return report_mistakes(diagnostics, options);
  }
  how.search = search_options(options, limits);
  const auto answer = synthesis::schedule_scenario(wanted, how, diagnostics);
  if (!answer) return report_mistakes(diagnostics, options);
  for (const std::string& each : answer->wrong)
    std::fprintf(stderr, "takt: %s is answered wrongly: %s\n", wanted.name.c_str(), each.c_str());
  if (!answer->wrong.empty()) return ExitStatus::internal_error;
  if (options.format == "json") std::fputs(json::write(*answer).c_str(), stdout);
  if (options.format == "text") print(synthesis::text_of(wanted.name, *answer));
  if (options.format == "neutral" && answer->certificate)
    std::fputs(
        (json::compact(schedule_instances::write_certificate(*answer->instance, *answer->certificate)) + "\n").c_str(),
        stdout);
  else if (options.format == "neutral" && answer->instance)
    std::fputs((json::compact(schedule_instances::write_problem(*answer->instance)) + "\n").c_str(), stdout);
  if (options.out && answer->resolved && !write_file(*options.out, json::encode(answer->resolved->scenario)))
    return ExitStatus::internal_error;
  if (options.certificate && answer->certificate &&
      !write_file(*options.certificate,
                  json::compact(schedule_instances::write_certificate(*answer->instance, *answer->certificate)) + "\n"))
    return ExitStatus::internal_error;
  if (answer->verdict == Decision::Verdict::infeasible) return ExitStatus::requirement_failed;
  return answer->verdict == Decision::Verdict::scheduled ? ExitStatus::pass : ExitStatus::undecided;
}

bool is_scenario(const ScheduleOptions& options) {
  return options.files.size() == 1 && !schedule_instances::is_instance(options.files.front());
}

/// A scheduled scenario, and perhaps what it was made of.
ExitStatus change_scenario(const ScheduleOptions& options) {
  ScenarioChangeOptions change = options.scenario_change;
  change.running = *options.to;
  if (!options.files.empty()) change.wanted = options.files.front();
  change.add = options.change.add;
  change.remove = options.change.remove;
  change.fail = options.change.fail;
  change.plant = options.change.plant;
  change.out = options.out;
  change.entries = options.entries;
  change.is_json = options.format == "json";
  return change_scheduled_scenario(change);
}

/// Options that mean nothing where they stand.
void check_change(const ScheduleOptions& options, json::Diagnostics& diagnostics) {
  const json::Place place{"command line", 0, 0, ""};
  if (options.files.empty() && !options.to)
    diagnostics.error(place, "nothing to schedule",
                      {"no file", "SCENARIO, INSTANCE, or --to SCHEDULE with what changes"});
  if (!options.to &&
      (options.change.add || options.change.plant || !options.change.remove.empty() || !options.change.fail.empty()))
    diagnostics.error(place, "a change without a schedule",
                      {"--add, --remove, --fail or --plant", "--to SCHEDULE as well"});
  const bool is_of_scenario = options.to && (options.files.empty() || is_scenario(options));
  if (!is_of_scenario &&
      (options.scenario_change.transition || options.scenario_change.at || options.scenario_change.lead))
    diagnostics.error(
        place, "a transition of what is no scenario",
        {"--transition, --at or --lead", "--to SCENARIO, a scheduled one: of an instance no transition is planned"});
  if (is_of_scenario &&
      (options.certificate || options.gates || options.objective != "feasible" || options.format == "neutral"))
    diagnostics.error(place, "an option that a change of a scenario does not have",
                      {"--certificate, --gates, --objective or --format neutral",
                       "--to with --add, --remove or --fail, and where the answer goes"});
}

/// Of several instances the worst counts: undecided, then infeasible, then scheduled.
ExitStatus worse(ExitStatus a, ExitStatus b) {
  const auto rank = [](ExitStatus s) {
    return s == ExitStatus::pass ? 0 : s == ExitStatus::requirement_failed ? 1 : s == ExitStatus::undecided ? 2 : 3;
  };
  return rank(b) > rank(a) ? b : a;
}

/// Ten seconds if nothing is said.
Limits limits_of(const ScheduleOptions& options, json::Diagnostics& diagnostics) {
  const auto read = [&](const std::optional<std::string>& text, const char* option) -> std::optional<sim::Duration> {
    if (!text) return std::nullopt;
    const auto limit = json::parse_duration(*text);
    if (limit && (*limit).ps() > 0) return *limit;
    diagnostics.error({option, 0, 0, ""}, "not a time to search", {json::quote(*text), "a duration such as \"10s\""});
    return std::nullopt;
  };
  Limits limits{read(options.limit, "--limit"), read(options.cpu_limit, "--cpu-limit")};
  if (!options.limit && !options.cpu_limit) limits.wall = sim::Duration::from_ps(10'000'000'000'000);
  return limits;
}

ExitStatus run(const ScheduleOptions& options) {
  json::Diagnostics diagnostics;
  const Limits limits = limits_of(options, diagnostics);
  if (diagnostics.has_errors()) return report_mistakes(diagnostics, options);
  // A folder ("DIR/") has a file for each instance.
  const std::string out = options.out.value_or(""), certificate = options.certificate.value_or(""),
                    plant = options.change.plant.value_or(""),
                    transition = options.scenario_change.transition.value_or("");
  if (!can_write({{"--out", out, Place::Kind::either},
                  {"--certificate", certificate, Place::Kind::either},
                  {"--plant", plant, Place::Kind::file},
                  {"--transition", transition, Place::Kind::file}},
                 options.format == "json"))
    return ExitStatus::bad_input;
  check_change(options, diagnostics);
  if (diagnostics.has_errors()) return report_mistakes(diagnostics, options);
  if (options.to && (options.files.empty() || is_scenario(options))) return change_scenario(options);
  if (is_scenario(options)) return schedule_scenario(options, limits);
  schedule_instances::InstanceReader reader(options.files);
  ExitStatus status = ExitStatus::pass;
  json::Node reports = json::Node::array();
  bool any = false;
  while (!reader.is_at_end()) {
    auto problem = reader.next(diagnostics);
    if (!problem && !diagnostics.has_errors()) break;
    if (problem && options.to) {
      ChangeOptions change = options.change;
      change.schedule = *options.to;
      change.out = options.out;
      change.is_json = options.format == "json";
      return change_schedule(std::move(*problem), change);
    }
    if (problem && options.routes == "given")
      for (const schedule::Stream& stream : problem->streams)
        if (!stream.route)
          diagnostics.error({options.files.front(), 0, 0, ""},
                            fmt::format("stream {} has no route", json::quote(stream.name)),
                            {"--routes given", "--routes shortest or search"});
    if (diagnostics.has_errors()) return report_mistakes(diagnostics, options);
    any = true;
    status = worse(status, schedule_instance(*problem, options, limits, reports));
    if (status == ExitStatus::internal_error) return status;
  }
  if (!any) {
    diagnostics.error({options.files.front(), 0, 0, ""}, "a network without streams",
                      {"no streams beside it", "a set of streams behind it"});
    return report_mistakes(diagnostics, options);
  }
  if (options.format == "json")
    std::fputs(json::pretty(reports.items.size() == 1 ? reports.items.front() : reports).c_str(), stdout);
  return status;
}

}  // namespace

void add_schedule_command(Command app, ExitStatus& status) {
  const Command command = app.add_subcommand("schedule", companion_help("schedule"));
  const auto options = std::make_shared<ScheduleOptions>();
  command.add_option("SCENARIO|INSTANCE", options->files,
                     "A scenario with automatic gates, or instances: TAS_Benchmark, TSNBenchScenarios, tsnkit, "
                     "TSNsched, ECRTS'25, GraphML with applications or neutral, told by their content; network and "
                     "streams one after the other where they are two files. With --to a scenario need not be given");
  command
      .add_option("--routes", options->routes,
                  "given: streams without a route are refused, of a scenario only \"route\": \"auto\" is searched for; "
                  "shortest: one way each; search: other ways, too")
      .one_of({"given", "shortest", "search"})
      .type_name("ROUTES");
  command
      .add_option("--objective", options->objective,
                  "feasible: the first schedule; latency, entries: of an instance the best of twelve attempts; slack: "
                  "the greatest clock error")
      .one_of({"feasible", "latency", "entries", "slack"})
      .type_name("WHAT");
  command.add_option("--limit", options->limit, "How long to search each instance, by the clock on the wall")
      .type_name("D")
      .default_text("10s; with --cpu-limit no end");
  command
      .add_option("--cpu-limit", options->cpu_limit,
                  "How much time of the processors each search may take, of all threads together")
      .type_name("D")
      .default_text("no end");
  command.add_option("--seed", options->seed, "The seed of the search").type_name("N");
  command.add_option("--jobs", options->jobs, "Threads; the result is the same for any number")
      .type_name("N")
      .default_text("one for each processor");
  command.add_flag("--gates", options->gates, "Gate control lists, too");
  command.add_option("--entries", options->entries, "Entries that a list may have, where the port takes more")
      .type_name("N")
      .default_text("as many as the port takes");
  command
      .add_option("--out", options->out,
                  "Where the schedule goes: of a scenario a scenario, of an instance neutral JSON; DIR/ for one file "
                  "an instance")
      .type_name("FILE");
  command
      .add_option("--certificate", options->certificate,
                  "Where a proof of infeasibility goes; DIR/ for one file an instance")
      .type_name("FILE");
  command
      .add_option("--to", options->to,
                  "A schedule of the instance or scenario (as --out writes it) that runs and is changed; nobody moves "
                  "who need not")
      .type_name("SCHEDULE");
  command
      .add_option("--add", options->change.add,
                  "Streams that come: {\"streams\": [...]} as in a neutral instance, or as in a scenario")
      .type_name("FILE");
  command.add_option("--remove", options->change.remove, "A stream that goes (repeatable)")
      .type_name("STREAM")
      .one_value_each();
  command
      .add_option("--fail", options->change.fail,
                  "A link that is gone, of a scenario the cable or a node: its streams take other ways (repeatable)")
      .type_name("LINK")
      .one_value_each();
  command
      .add_option("--plant", options->change.plant,
                  "Where the instance goes as it is after the change, or the scenario with automatic gates")
      .type_name("FILE");
  command
      .add_option("--transition", options->scenario_change.transition,
                  "Where the way from one schedule of a scenario to the next goes, as a scenario that can be run")
      .type_name("FILE");
  command.add_option("--at", options->scenario_change.at, "Of a scenario: when the change begins")
      .type_name("D")
      .default_text("as soon as all streams have sent for two periods");
  command
      .add_option("--lead", options->scenario_change.lead,
                  "Of a scenario: how long before it holds a list is written, at least")
      .type_name("D")
      .default_text("10ms");
  command.add_option("--format", options->format, "text, json or neutral (the schedule or the certificate)")
      .one_of({"text", "json", "neutral"})
      .type_name("FORMAT");
  command.footer(
      "Examples:\n"
      "  takt schedule plant.json --out scheduled.json            a scenario with offsets, paths and gate lists, "
      "judged\n"
      "  takt schedule instance.json --out schedule.json          a schedule, or the reason why there is none\n"
      "  takt schedule ring.top set1.pat set2.pat                 several sets of streams on one network\n"
      "  takt schedule task.csv topo.csv --gates --entries 16     with lists that a small switch takes\n"
      "  takt schedule plant.json --to schedule.json --add new.json --out changed.json\n"
      "                                                           a stream more, the others stay\n"
      "  takt schedule --to scheduled.json --add stream.json --out changed.json --transition transition.json\n"
      "                                                           a scenario: the way from list to list, too, "
      "simulated\n"
      "  takt schedule cell.json --objective slack                how far clocks may differ\n"
      "Exit status: 0 scheduled, 1 infeasible (proved), 4 undecided (or no lists), 2 mistakes (all of them are "
      "listed), 3 internal error.");
  command.callback([options, &status] { status = run(*options); });
}

}  // namespace takt::cli
