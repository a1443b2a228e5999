// SPDX-License-Identifier: Apache-2.0
#include "study/scheduling.hpp"

#include <algorithm>

#include "schedule_instances/report.hpp"
#include "json/node.hpp"
#include "json/quantity.hpp"
#include "models/ethernet/sizes.hpp"
#include "schedule_check/instance_check.hpp"
#include "sim/check.hpp"
#include "sim/digest.hpp"
#include "sim/random.hpp"
#include "synthesis/instance_of_scenario.hpp"

namespace takt::study {
namespace {

using schedule_instances::ScheduleReport;
using Verdict = schedule::Decision::Verdict;

constexpr std::uint8_t scheduled_class = 6;

/// A figure of a report; nothing where it has none.
struct Column {
  SchedulingFigure figure;
  std::optional<double> (*of)(const ScheduleReport&);
};

std::optional<double> number(const std::optional<std::uint64_t>& value) {
  return value ? std::optional(static_cast<double>(*value)) : std::nullopt;
}
std::optional<double> is(const ScheduleReport& report, std::string_view verdict) {
  return report.verdict == verdict ? 1.0 : 0.0;
}

constexpr Column columns[] = {
    {{"scheduled", "1 if there is a schedule, else 0"}, [](const ScheduleReport& r) { return is(r, "scheduled"); }},
    {{"infeasible", "1 if it is proved that there is none, else 0"},
     [](const ScheduleReport& r) { return is(r, "infeasible"); }},
    {{"undecided", "1 if neither was found in so many attempts, else 0"},
     [](const ScheduleReport& r) { return is(r, "undecided"); }},
    {{"left_over", "streams that the best partial schedule leaves out; 0 of a whole one"},
     [](const ScheduleReport& r) { return std::optional(static_cast<double>(r.left_over.size())); }},
    {{"busiest_link", "share of its time that the busiest link is used by what is scheduled"},
     [](const ScheduleReport& r) { return std::optional(r.busiest_link); }},
    {{"normalised_latency", "mean over the streams: latency over the least on any way; of schedules"},
     [](const ScheduleReport& r) { return r.normalised_latency; }},
    {{"waiting", "streams that wait in some bridge; of schedules"},
     [](const ScheduleReport& r) { return number(r.waiting); }},
};

std::uint64_t digest_of(const schedule::Decision& decision) {
  std::uint64_t digest = sim::mix64(static_cast<std::uint64_t>(decision.verdict) + 1);
  const auto take = [&digest](std::uint64_t value) { digest = sim::mix64(digest ^ value) + 0x9E3779B97F4A7C15ULL; };
  for (const std::optional<schedule::Placement>& each : decision.found.solution.streams) {
    take(each.has_value());
    if (!each) continue;
    for (const schedule::LinkIndex link : each->route) take(link);
    for (const auto& starts : each->starts)
      for (const schedule::Ps start : starts) take(static_cast<std::uint64_t>(start));
  }
  return digest;
}

std::vector<schedule::NodeIndex> hosts_of(const scenario::Resolved& resolved) {
  std::vector<schedule::NodeIndex> hosts;
  for (schedule::NodeIndex n = 0; n < resolved.topology.nodes.size(); ++n)
    if (resolved.topology.nodes[n].is_end_station() && !resolved.topology.neighbours[n].empty()) hosts.push_back(n);
  return hosts;
}

}  // namespace

std::vector<SchedulingFigure> scheduling_figures() {
  std::vector<SchedulingFigure> all;
  for (const Column& column : columns) all.push_back(column.figure);
  return all;
}

void check_scheduling(const scenario::Resolved& resolved, const Scheduling& wanted, json::Diagnostics& diagnostics) {
  if (!resolved.plan.streams.empty() || !resolved.programs.empty() || !resolved.applications.empty())
    diagnostics.error(
        wanted.where.place(), "traffic in a study of schedules",
        {"streams, Programs or applications of the scenario", "a network alone, on which streams are drawn"});
  if (hosts_of(resolved).size() < 2)
    diagnostics.error(wanted.where.place(), "streams that cannot be drawn",
                      {"fewer than two hosts in the network", "two or more"});
  for (const sim::Duration every : wanted.streams.every)
    for (const sim::Duration latency : wanted.streams.latency)
      if (latency > every * 1000)
        diagnostics.error(wanted.streams.where.at("latency"), "a latency of more than a thousand periods",
                          {json::to_text(latency), "at most " + json::to_text(every * 1000)});
}

schedule::Problem drawn_problem(const scenario::Resolved& resolved, const Scheduling& wanted, std::uint64_t seed) {
  schedule::Problem problem = synthesis::network_of(resolved).problem;
  problem.name = resolved.scenario.name;
  problem.model.is_strict = true;
  problem.model.no_wait = !wanted.waiting;
  problem.model.margin = wanted.margin.ps();
  const std::vector<schedule::NodeIndex> hosts = hosts_of(resolved);
  for (std::uint32_t i = 0; i < wanted.streams.count; ++i) {
    schedule::Stream stream;
    stream.name = "s" + std::to_string(i + 1);
    sim::RandomStream random(seed, stream.name, "drawn streams");
    const auto one_of = [&random](const auto& list) { return list[random.below(list.size())]; };
    const std::uint64_t from = random.below(hosts.size()), further = 1 + random.below(hosts.size() - 1);
    stream.talker = hosts[from];
    stream.listeners = {hosts[(from + further) % hosts.size()]};
    stream.period = one_of(wanted.streams.every).ps();
    stream.octets = static_cast<std::uint32_t>(
        models::frame_length(one_of(wanted.streams.payload) + models::ipv4_and_udp_headers, true).count);
    if (!wanted.streams.latency.empty()) stream.latency = one_of(wanted.streams.latency).ps();
    stream.traffic_class = scheduled_class;
    problem.streams.push_back(std::move(stream));
  }
  return problem;
}

Scheduled schedule_point(const schedule::Problem& problem, const Scheduling& wanted, std::uint64_t seed,
                         unsigned threads) {
  schedule::SearchOptions how;
  how.routes =
      wanted.routes == SearchedRoutes::search ? schedule::RouteChoice::search : schedule::RouteChoice::shortest;
  how.seed = seed;
  how.jobs = threads;
  how.attempts = wanted.attempts;
  const schedule::Decision decision = schedule_check::decide_judged(problem, how);
  if (decision.verdict == Verdict::scheduled)
    TAKT_CHECK(schedule_check::check(problem, decision.found.solution).empty(), "a schedule is one by its definition");
  const ScheduleReport report = schedule_instances::report(problem, decision, std::nullopt);
  Scheduled made{report.verdict, digest_of(decision), decision.found.steps, json::Node::object()};
  for (const Column& column : columns)
    if (const std::optional<double> value = column.of(report))
      made.figures.add(column.figure.name, json::Node::of_double(*value));
  return made;
}

}  // namespace takt::study
