// SPDX-License-Identifier: Apache-2.0
// takt.schedule and takt.explore.
#include <algorithm>
#include <thread>

#include "explore/report/report.hpp"
#include "explore/search/search.hpp"
#include "schedule_instances/instances.hpp"
#include "schedule_instances/report.hpp"
#include "schedule_instances/write.hpp"
#include "json/fields.hpp"
#include "json/override.hpp"
#include "json/quantity.hpp"
#include "python/common.hpp"
#include "schedule/gate_lists.hpp"
#include "schedule_check/instance_check.hpp"
#include "synthesis/report.hpp"
#include "verify/group_question.hpp"

namespace takt::python {
namespace {

namespace instances = schedule_instances;

struct HowToSchedule {
  std::string routes;
  std::string objective;
  sim::Duration limit;
  std::uint64_t seed = 1;
  unsigned jobs = 0;
  std::uint32_t entries = 1'000'000;
  bool gates = false;
};

HowToSchedule how_to_schedule(const std::string& routes, const std::string& objective, const std::string& limit,
                              std::uint64_t seed, unsigned jobs, std::uint32_t entries, bool gates) {
  const auto is_one_of = [](const std::string& text, std::initializer_list<const char*> choices) {
    return std::ranges::find(choices, text) != choices.end();
  };
  if (!is_one_of(routes, {"given", "shortest", "search"}))
    throw Mistake("routes: found " + json::quote(routes) + ", expected given, shortest or search");
  if (!is_one_of(objective, {"feasible", "latency", "entries", "slack"}))
    throw Mistake("objective: found " + json::quote(objective) + ", expected feasible, latency, entries or slack");
  const auto time = json::parse_duration(limit);
  if (!time || (*time).ps() <= 0) throw Mistake("limit: not a time to search: " + json::quote(limit));
  return {routes, objective, *time, seed, jobs, entries, gates};
}

schedule::SearchOptions search_options(const HowToSchedule& how, Watch& watch) {
  schedule::SearchOptions options;
  options.routes = how.routes == "search" ? schedule::RouteChoice::search : schedule::RouteChoice::shortest;
  options.seed = how.seed;
  options.jobs = how.jobs == 0 ? std::max(1u, std::thread::hardware_concurrency()) : how.jobs;
  options.attempts = 1'000'000;
  const auto begin = std::chrono::steady_clock::now();
  const auto length = std::chrono::nanoseconds(how.limit.ps() / 1'000);
  options.stop = [begin, length, &watch] {
    const auto spent = std::chrono::steady_clock::now() - begin;
    return !watch.keep_going(std::min(
               1.0, std::chrono::duration<double>(spent).count() / std::chrono::duration<double>(length).count())) ||
           spent > length;
  };
  return options;
}

/// Whoever is wrong, takt must not say it.
void judge(const std::string& name, const std::vector<std::string>& wrong) {
  if (!wrong.empty()) throw std::runtime_error(name + " is answered wrongly: " + wrong.front());
}

/// The report, the resolved scenario if there is a schedule, and the certificate if there is none; "" for nothing.
py::tuple schedule_scenario(const scenario::Scenario& wanted, const HowToSchedule& how, const Progress& progress) {
  if (how.objective == "latency" || how.objective == "entries")
    throw Mistake("objective: found a scenario and " + json::quote(how.objective) + ", expected feasible or slack");
  Watch watch(progress);
  json::Diagnostics diagnostics;
  std::string report, made, certificate;
  std::vector<std::string> wrong;
  {
    const py::gil_scoped_release unlocked;
    synthesis::ScenarioOptions options;
    options.may_route = how.routes == "search";
    options.may_route_open = how.routes != "shortest";
    options.entries = std::min<std::uint32_t>(how.entries, scenario::most_gate_entries);
    options.wants_slack = how.objective == "slack";
    options.search = search_options(how, watch);
    if (const auto answer = synthesis::schedule_scenario(wanted, options, diagnostics)) {
      wrong = answer->wrong;
      report = json::write(*answer);
      if (answer->resolved) made = json::encode(answer->resolved->scenario);
      if (answer->certificate)
        certificate = json::compact(instances::write_certificate(*answer->instance, *answer->certificate));
    }
  }
  watch.raise();
  if (report.empty()) throw mistake_of(diagnostics);
  judge(wanted.name, wrong);
  return py::make_tuple(report, made, certificate);
}

/// As above, with the schedule instead of the scenario.
py::tuple schedule_problem(const schedule::Problem& problem, const HowToSchedule& how, const Progress& progress) {
  if (how.routes == "given")
    for (const schedule::Stream& stream : problem.streams)
      if (!stream.route)
        throw Mistake("routes: stream " + json::quote(stream.name) + " has none, expected shortest or search");
  Watch watch(progress);
  std::string report, solution, certificate;
  std::vector<std::string> wrong;
  {
    const py::gil_scoped_release unlocked;
    using schedule::Objective;
    const Objective objective = how.objective == "latency"   ? Objective::latency
                                : how.objective == "entries" ? Objective::entries
                                : how.objective == "slack"   ? Objective::slack
                                                             : Objective::feasible;
    schedule::Decision decision = schedule_check::decide_judged(problem, search_options(how, watch), objective);
    const bool is_scheduled = decision.verdict == schedule::Decision::Verdict::scheduled;
    std::optional<std::string> no_lists;
    if (how.gates && is_scheduled)
      no_lists = schedule::make_gate_lists(problem, decision.found.solution, {how.entries});
    if (is_scheduled) {
      schedule::Problem with_margin = problem;
      with_margin.model.margin = decision.margin;
      wrong = schedule_check::check(with_margin, decision.found.solution);
      solution = json::compact(instances::write_solution(problem, decision.found.solution));
    }
    if (decision.certificate) certificate = json::compact(instances::write_certificate(problem, *decision.certificate));
    report =
        json::compact(json::ShapeOf<instances::ScheduleReport>::write(instances::report(problem, decision, no_lists)));
  }
  watch.raise();
  judge(problem.name, wrong);
  return py::make_tuple(report, solution, certificate);
}

scenario::Scenario wanted_of(const std::optional<json::Document>& parsed, const std::vector<std::string>& overrides,
                             json::Diagnostics& diagnostics) {
  scenario::Scenario wanted;
  if (parsed) {
    json::Document document = *parsed;
    for (const std::string& each : overrides) json::apply(document, each, diagnostics);
    if (!diagnostics.has_errors()) json::decode(document, wanted, diagnostics);
  }
  if (diagnostics.has_errors()) throw mistake_of(diagnostics);
  return wanted;
}

/// A list: for one scenario one tuple, of instances one each.
py::list schedule_files(const std::vector<std::string>& paths, const HowToSchedule& how, const Progress& progress) {
  py::list answers;
  if (paths.empty()) throw Mistake("schedule: no file");
  json::Diagnostics diagnostics;
  if (paths.size() == 1 && !instances::is_instance(paths.front())) {
    const scenario::Scenario wanted = wanted_of(json::parse_file(paths.front(), diagnostics), {}, diagnostics);
    answers.append(schedule_scenario(wanted, how, progress));
    return answers;
  }
  instances::InstanceReader reader(paths);
  while (!reader.is_at_end()) {
    const auto problem = reader.next(diagnostics);
    if (diagnostics.has_errors()) throw mistake_of(diagnostics);
    if (problem) answers.append(schedule_problem(*problem, how, progress));
  }
  if (py::len(answers) == 0)
    throw Mistake(paths.front() + ": a network without streams: expected a set of streams behind it");
  return answers;
}

py::tuple schedule_text(const std::string& text, const std::string& name, const std::vector<std::string>& overrides,
                        const HowToSchedule& how, const Progress& progress) {
  json::Diagnostics diagnostics;
  const scenario::Scenario wanted = wanted_of(json::parse(text, name, diagnostics), overrides, diagnostics);
  return schedule_scenario(wanted, how, progress);
}
py::tuple schedule_file(const std::string& path, const std::vector<std::string>& overrides, const HowToSchedule& how,
                        const Progress& progress) {
  json::Diagnostics diagnostics;
  const scenario::Scenario wanted = wanted_of(json::parse_file(path, diagnostics), overrides, diagnostics);
  return schedule_scenario(wanted, how, progress);
}

template <class T>
std::optional<T> number_in(const py::dict& given, const char* key) {
  if (!given.contains(key) || given[key].is_none()) return std::nullopt;
  const py::object value = given[key];
  if (!py::isinstance<py::int_>(value)) throw Mistake(std::string(key) + ": expected a whole number");
  const auto number = value.cast<std::int64_t>();
  if (number < 0 || static_cast<std::uint64_t>(number) > std::numeric_limits<T>::max())
    throw Mistake(std::string(key) + ": found " + std::to_string(number) +
                  ", expected a whole number that is not negative");
  return static_cast<T>(number);
}

/// The arguments are those of takt/__init__.py, which has all of them.
verify::GroupQuestion question_of(const py::dict& given) {
  verify::GroupQuestion question;
  question.slaves = number_in<unsigned>(given, "slaves");
  question.inner_slaves = number_in<unsigned>(given, "inner_slaves");
  question.candidates = number_in<unsigned>(given, "candidates");
  question.key_changes = number_in<unsigned>(given, "key_changes");
  question.calls = number_in<std::uint32_t>(given, "calls");
  question.query.fault_budget = number_in<std::uint32_t>(given, "fault_budget").value_or(question.query.fault_budget);
  question.query.depth = number_in<std::uint32_t>(given, "depth").value_or(question.query.depth);
  question.query.states = number_in<std::uint64_t>(given, "budget").value_or(question.query.states);
  question.query.joining = given["joining"].cast<bool>();
  question.variant = given["variant"].cast<std::optional<std::string>>();
  question.subscription = given["subscription"].cast<std::optional<std::string>>();
  question.faults = given["faults"].cast<std::vector<std::string>>();
  question.network = given["network"].cast<std::string>();
  question.beginnings = given["beginnings"].cast<std::string>();
  question.nested = given["nested"].cast<bool>();
  question.starts_again = given["starts_again"].cast<bool>();
  question.is_signed = given["signed"].cast<bool>();
  question.no_symmetry = !given["symmetry"].cast<bool>();
  question.no_finish = !given["finish"].cast<bool>();
  return question;
}

/// One text a group: as takt explore --format json writes it.
std::vector<std::string> explore_groups(const Scenario* scenario, const py::dict& given, const Progress& progress) {
  const verify::Groups groups =
      verify::groups_of(question_of(given), scenario == nullptr ? nullptr : scenario->resolved.get());
  if (!groups.mistake.empty()) throw Mistake(groups.mistake);
  std::vector<std::string> pages;
  for (const verify::Group& group : groups.groups) {
    Watch watch(progress);
    {
      const py::gil_scoped_release unlocked;
      const explore::SearchResult found = explore::explore(group.query, [&](const explore::Progress& now) {
        return watch.keep_going(now.states == 0 ? 0 : static_cast<double>(now.done) / static_cast<double>(now.states));
      });
      pages.push_back(json::compact(
          json::ShapeOf<explore::Exploration>::write({scenario == nullptr ? "" : group.name, group.query, found, 0})));
    }
    watch.raise();
  }
  return pages;
}

}  // namespace

void add_questions(py::module_& m) {
  py::class_<HowToSchedule>(m, "HowToSchedule").def(py::init(&how_to_schedule));
  m.def("schedule_files", &schedule_files);
  m.def("schedule_file", &schedule_file);
  m.def("schedule_text", &schedule_text);
  m.def("explore", &explore_groups);
}

}  // namespace takt::python
