// SPDX-License-Identifier: Apache-2.0
#include "schedule_instances/report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>

#include "schedule_instances/proof.hpp"
#include "schedule/crossings.hpp"
#include "schedule/gate_lists.hpp"

namespace takt::schedule_instances {

using namespace schedule;

const json::Record& describe(json::Type<LeftOverReport>) {
  static constexpr json::Output outputs[] = {
      json::output<&LeftOverReport::stream>("stream", "A stream that has no place."),
      json::output<&LeftOverReport::in_the_way>("in_the_way", "The streams that it would meet where it meets fewest."),
  };
  static constexpr json::Record record{"left_over", "A stream that the best partial schedule leaves out.", outputs};
  return record;
}

const json::Record& describe(json::Type<ChangeReport>) {
  static constexpr json::Output outputs[] = {
      json::output<&ChangeReport::change>("change", "add, remove or fail."),
      json::output<&ChangeReport::name>("name", "Of the stream, or of the link that failed."),
      json::output<&ChangeReport::done>("done", "Whether there is a place for all that it concerns."),
      json::output<&ChangeReport::moved>("moved", "Streams that move."),
      json::output<&ChangeReport::lost>("lost", "Streams that have no place any more."),
  };
  static constexpr json::Record record{"change", "A change of a schedule that runs.", outputs};
  return record;
}

const json::Record& describe(json::Type<ScheduleReport>) {
  static constexpr json::Output outputs[] = {
      json::output<&ScheduleReport::instance>("instance", "Its name."),
      json::output<&ScheduleReport::source>("source", "The format that it came in."),
      json::output<&ScheduleReport::streams>("streams", "Streams to schedule."),
      json::output<&ScheduleReport::links>("links", "Links of the network, by direction."),
      json::output<&ScheduleReport::verdict>("verdict", "scheduled, infeasible or undecided."),
      json::output<&ScheduleReport::how>("how",
                                         "first fit or search; of an infeasible one the kind of its certificate: "
                                         "latency, load, interval, folded, pair, clausal."),
      json::output_if_any<&ScheduleReport::proof>("proof", "Why there is no schedule.", "infeasible"),
      json::output<&ScheduleReport::busiest_link>(
          "busiest_link", "Share of its time that the busiest link is used by what is scheduled."),
      json::output_if_any<&ScheduleReport::normalised_latency>(
          "normalised_latency", "Mean over the streams: latency over the least on any way.", "scheduled"),
      json::output_if_any<&ScheduleReport::waiting>("waiting", "Streams that wait in some bridge.", "scheduled"),
      json::output_if_any<&ScheduleReport::gate_entries>("gate_entries", "Entries of the longest gate control list.",
                                                         "scheduled, with lists"),
      json::output_if_any<&ScheduleReport::margin>("margin", "How far the clocks of two nodes may differ.",
                                                   "scheduled"),
      json::output_if_any<&ScheduleReport::no_lists>("no_lists", "Why there are no gate control lists.",
                                                     "scheduled, without lists"),
      json::output_if_any<&ScheduleReport::left_over>(
          "left_over", "What the best partial schedule leaves out; of the first hundred with those in their way.",
          "undecided"),
  };
  static constexpr json::Record record{"schedule", "What became of an instance.", outputs};
  return record;
}

namespace {

std::string in_us(Ps time) { return fmt::format("{:.6g} us", static_cast<double>(time) / 1e6); }

/// Of the longest of each stream's latencies, over the least on any way.
double mean_normalised_latency(const Problem& problem, const Solution& solution) {
  const Crossings crossings(problem);
  double sum = 0;
  for (StreamIndex s = 0; s < problem.streams.size(); ++s) {
    const Stream& stream = problem.streams[s];
    const auto starts = crossings.earliest_starts(stream);
    Ps least = 0;
    for (const NodeIndex n : stream.listeners) least = std::max(least, crossings.arrival(stream, n, starts));
    Solution one;
    one.timing = solution.timing;
    one.streams.resize(problem.streams.size());
    one.streams[s] = solution.streams[s];
    sum += static_cast<double>(sum_of_latencies(problem, one)) / static_cast<double>(least);
  }
  return sum / static_cast<double>(problem.streams.size());
}

double busiest(const Problem& problem, const Solution& solution) {
  const Timing timing(problem, solution.timing);
  std::vector<double> load(problem.links.size());
  for (StreamIndex s = 0; s < solution.streams.size(); ++s)
    if (solution.streams[s])
      for (const LinkIndex l : solution.streams[s]->route)
        load[l] += static_cast<double>(timing.work(problem.streams[s], problem.links[l])) /
                   static_cast<double>(problem.streams[s].period);
  return load.empty() ? 0 : *std::max_element(load.begin(), load.end());
}

std::uint64_t count_waiting(const Problem& problem, const Solution& solution) {
  const Timing timing(problem, solution.timing);
  std::uint64_t count = 0;
  for (StreamIndex s = 0; s < solution.streams.size(); ++s) {
    const Placement& placement = *solution.streams[s];
    const auto way = make_way(timing, problem.streams[s], placement.route);
    bool waits = !way;
    for (std::size_t hop = 0; way && hop < placement.route.size(); ++hop)
      for (std::size_t k = 0; k < placement.starts[hop].size(); ++k)
        waits = waits || placement.starts[hop][k] - placement.starts[0][k] != way->lags[hop];
    count += waits ? 1 : 0;
  }
  return count;
}

}  // namespace

ScheduleReport report(const Problem& problem, const Decision& decision, const std::optional<std::string>& no_lists) {
  static constexpr const char* verdicts[] = {"scheduled", "infeasible", "undecided"};
  constexpr std::size_t most_measured = 5'000;
  ScheduleReport report;
  report.instance = problem.name;
  report.source = problem.source;
  report.streams = problem.streams.size();
  report.links = problem.links.size();
  report.verdict = verdicts[static_cast<std::size_t>(decision.verdict)];
  report.how = decision.certificate ? kind_of(*decision.certificate) : std::string(decision.how);
  if (decision.certificate) report.proof = proof_of(problem, *decision.certificate);
  report.busiest_link = busiest(problem, decision.found.solution);
  if (decision.verdict == Decision::Verdict::scheduled) {
    if (problem.streams.size() <= most_measured)
      report.normalised_latency = mean_normalised_latency(problem, decision.found.solution);
    report.waiting = count_waiting(problem, decision.found.solution);
    report.margin = sim::Duration::from_ps(decision.margin);
    if (!decision.found.solution.gates.empty()) report.gate_entries = most_entries(decision.found.solution);
    report.no_lists = no_lists;
  } else if (!decision.certificate) {
    for (const LeftOver& each : decision.found.left_over) {
      LeftOverReport row{problem.streams[each.stream].name, {}};
      for (const StreamIndex other : each.in_the_way) row.in_the_way.push_back(problem.streams[other].name);
      report.left_over.push_back(std::move(row));
    }
  }
  return report;
}

std::string text_of(const ChangeReport& report) {
  const auto names = [](const std::vector<std::string>& list) {
    std::string text;
    for (const std::string& each : list) text += (text.empty() ? "" : ", ") + json::quote(each);
    return text;
  };
  std::string text = fmt::format("{} {}: {}", report.change, json::quote(report.name),
                                 report.done           ? "done"
                                 : report.lost.empty() ? "no place"
                                                       : "not for all");
  if (!report.moved.empty()) text += ", moved: " + names(report.moved);
  if (!report.lost.empty()) text += ", lost: " + names(report.lost);
  return text + "\n";
}

std::string text_of(const ScheduleReport& report) {
  std::string text = fmt::format("{}: {} ({})", report.instance, report.verdict, report.how);
  if (report.proof) return text + "\n  " + *report.proof + "\n";
  text += fmt::format(", {} streams, busiest link {:.1f} %", report.streams, report.busiest_link * 100);
  if (report.normalised_latency) text += fmt::format(", latency {:.3f} of the least", *report.normalised_latency);
  if (report.waiting && *report.waiting > 0) text += fmt::format(", {} wait", *report.waiting);
  if (report.margin && report.margin->ps() > 0)
    text += fmt::format(", clocks may differ by {}", in_us(report.margin->ps()));
  if (report.gate_entries) text += fmt::format(", at most {} gate entries", *report.gate_entries);
  text += "\n";
  if (report.no_lists) text += "  no gate lists: " + *report.no_lists + "\n";
  constexpr std::size_t most = 10;
  for (std::size_t i = 0; i < std::min(most, report.left_over.size()); ++i) {
    const LeftOverReport& each = report.left_over[i];
    text += fmt::format("  left over: {}", json::quote(each.stream));
    for (std::size_t j = 0; j < std::min(most, each.in_the_way.size()); ++j)
      text += fmt::format("{} {}", j == 0 ? "; in its way:" : ",", json::quote(each.in_the_way[j]));
    text += "\n";
  }
  if (report.left_over.size() > most) text += fmt::format("  and {} more\n", report.left_over.size() - most);
  return text;
}

}  // namespace takt::schedule_instances
