// SPDX-License-Identifier: Apache-2.0
#include "cli/schedule_change.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <ctime>

#include "schedule_instances/report.hpp"
#include "schedule_instances/solutions.hpp"
#include "schedule_instances/write.hpp"
#include "json/document.hpp"
#include "output/result_folder.hpp"
#include "schedule/change.hpp"
#include "schedule_check/instance_check.hpp"

namespace takt::cli {
namespace {

namespace instances = schedule_instances;

ExitStatus print_diagnostics(const json::Diagnostics& diagnostics, bool as_json) {
  if (as_json)
    std::fputs(json::pretty(diagnostics.to_json()).c_str(), stdout);
  else
    std::fputs(diagnostics.to_text().c_str(), stderr);
  return ExitStatus::bad_input;
}

/// What a change does is noted while it is made, and timed.
class Changer {
 public:
  explicit Changer(schedule::Plant& plant) : plant_(plant) {}

  void add(schedule::Stream stream) {
    const std::string name = stream.name;
    const std::clock_t begin = std::clock();
    const auto added = plant_.add(std::move(stream));
    note("add", name, begin, added ? added->moved : std::vector<schedule::StreamIndex>{}, {}, added.has_value());
  }
  void remove(schedule::StreamIndex stream) {
    const std::clock_t begin = std::clock();
    plant_.remove(stream);
    note("remove", plant_.problem().streams[stream].name, begin, {}, {}, true);
  }
  void fail(schedule::LinkIndex link) {
    const std::clock_t begin = std::clock();
    const auto rerouted = plant_.fail(link);
    note("fail", plant_.problem().links[link].name, begin, rerouted.moved, rerouted.lost, rerouted.lost.empty());
  }

  std::vector<instances::ChangeReport> reports;
  double slowest = 0;  ///< seconds of the processor
  double together = 0;

 private:
  void note(const char* what, const std::string& name, std::clock_t begin,
            const std::vector<schedule::StreamIndex>& moved, const std::vector<schedule::StreamIndex>& lost,
            bool is_done) {
    const double took = static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC;
    slowest = std::max(slowest, took);
    together += took;
    instances::ChangeReport report{what, name, is_done, {}, {}};
    for (const auto s : moved) report.moved.push_back(plant_.problem().streams[s].name);
    for (const auto s : lost) report.lost.push_back(plant_.problem().streams[s].name);
    reports.push_back(std::move(report));
  }

  schedule::Plant& plant_;
};

/// The instance as it is after the changes: without streams that are gone, and the others' schedule.
std::pair<schedule::Problem, schedule::Solution> what_is_left(const schedule::Plant& plant) {
  std::pair<schedule::Problem, schedule::Solution> left{plant.problem(), plant.solution()};
  auto& [problem, solution] = left;
  std::vector<schedule::Stream> streams;
  std::vector<std::optional<schedule::Placement>> placements;
  for (std::size_t s = 0; s < problem.streams.size(); ++s) {
    if (!solution.streams[s]) continue;
    streams.push_back(problem.streams[s]);
    placements.push_back(solution.streams[s]);
  }
  problem.streams = std::move(streams);
  solution.streams = std::move(placements);
  return left;
}

template <class List>
std::optional<std::uint32_t> index_of(const List& list, const std::string& name) {
  const auto found = std::find_if(list.begin(), list.end(), [&](const auto& each) { return each.name == name; });
  return found == list.end() ? std::nullopt : std::optional(static_cast<std::uint32_t>(found - list.begin()));
}

}  // namespace

ExitStatus change_schedule(schedule::Problem problem, const ChangeOptions& options) {
  json::Diagnostics diagnostics;
  schedule::Solution before;
  std::vector<schedule::Stream> coming;
  if (const auto document = json::parse_file(options.schedule, diagnostics))
    before = instances::read_solution(*document, problem, diagnostics);
  if (options.add)
    if (const auto document = json::parse_file(*options.add, diagnostics))
      coming = instances::read_streams(*document, problem, diagnostics);
  std::vector<std::uint32_t> leaving, failing;
  for (const std::string& name : options.remove) {
    if (const auto index = index_of(problem.streams, name))
      leaving.push_back(*index);
    else
      diagnostics.error({"--remove", 0, 0, ""}, "there is no stream " + json::quote(name));
  }
  for (const std::string& name : options.fail) {
    if (const auto index = index_of(problem.links, name))
      failing.push_back(*index);
    else
      diagnostics.error({"--fail", 0, 0, ""}, "there is no link " + json::quote(name));
  }
  if (!diagnostics.has_errors()) {
    const auto wrong = schedule_check::check(problem, before, 1);
    if (!wrong.empty())
      diagnostics.error({options.schedule, 0, 0, ""}, "no schedule of the instance",
                        {wrong.front(), "one that nothing is wrong with"});
    else if (const std::string why = schedule::why_not_changeable(problem, before); !why.empty())
      diagnostics.error({options.schedule, 0, 0, ""}, "a schedule that cannot be changed stream by stream",
                        {why, "streams that repeat strictly and do not wait"});
  }
  if (diagnostics.has_errors()) return print_diagnostics(diagnostics, options.is_json);
  schedule::Plant plant(std::move(problem), before);
  Changer changer(plant);
  for (const auto stream : leaving) changer.remove(stream);
  for (const auto link : failing) changer.fail(link);
  for (schedule::Stream& stream : coming) changer.add(std::move(stream));
  const auto [after, solution] = what_is_left(plant);
  const auto wrong = schedule_check::check(after, solution);
  for (const std::string& each : wrong) std::fprintf(stderr, "takt: the change is wrong: %s\n", each.c_str());
  if (!wrong.empty()) return ExitStatus::internal_error;
  bool all_done = true;
  json::Node rows = json::Node::array();
  for (const instances::ChangeReport& each : changer.reports) {
    all_done = all_done && each.done;
    if (options.is_json)
      rows.items.push_back(json::ShapeOf<instances::ChangeReport>::write(each));
    else
      std::fputs(instances::text_of(each).c_str(), stdout);
  }
  if (options.is_json)
    std::fputs(json::pretty(rows).c_str(), stdout);
  else
    std::fputs(
        fmt::format("{} changes in {:.3f} ms of the processor, the slowest in {:.3f} ms; {} streams are scheduled\n",
                    changer.reports.size(), changer.together * 1e3, changer.slowest * 1e3, after.streams.size())
            .c_str(),
        stdout);
  const auto write = [](const std::string& path, const json::Node& node) {
    const std::string problem_with_it = output::write_file(path, json::compact(node) + "\n");
    if (!problem_with_it.empty()) std::fprintf(stderr, "takt: cannot write %s\n", problem_with_it.c_str());
    return problem_with_it.empty();
  };
  if (options.out && !write(*options.out, instances::write_solution(after, solution)))
    return ExitStatus::internal_error;
  if (options.plant && !write(*options.plant, instances::write_problem(after))) return ExitStatus::internal_error;
  return all_done ? ExitStatus::pass : ExitStatus::undecided;
}

}  // namespace takt::cli
