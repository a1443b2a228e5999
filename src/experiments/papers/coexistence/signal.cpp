// SPDX-License-Identifier: Apache-2.0
#include "papers/coexistence/signal.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

namespace takt::papers::coexistence {
namespace {

double mean_of(const std::vector<double>& values) {
  double sum = 0;
  for (const double value : values) sum += value;
  return values.empty() ? 0 : sum / static_cast<double>(values.size());
}

double deviation_of(const std::vector<double>& values) {
  const double mean = mean_of(values);
  double squares = 0;
  for (const double value : values) squares += (value - mean) * (value - mean);
  return values.size() < 2 ? 0 : std::sqrt(squares / static_cast<double>(values.size() - 1));
}

double share_off(const std::vector<double>& pulses, double limit) {
  const auto off =
      std::count_if(pulses.begin(), pulses.end(), [limit](double pulse) { return std::abs(pulse - 1) > limit; });
  return static_cast<double>(off) / static_cast<double>(pulses.size());
}

}  // namespace

SignalStatistics measure(const std::vector<SignalEdge>& edges, sim::Duration interval, sim::TrueTime from,
                         sim::TrueTime to) {
  const auto intervals = [interval](sim::Duration d) {
    return static_cast<double>(d.ps()) / static_cast<double>(interval.ps());
  };
  std::vector<double> pulses;
  std::vector<double> periods;
  std::optional<sim::TrueTime> before;
  std::optional<sim::TrueTime> rise;
  for (const SignalEdge& edge : edges) {
    if (edge.time < from || edge.time > to) continue;
    if (before) pulses.push_back(intervals(edge.time - *before));
    before = edge.time;
    if (!edge.is_high) continue;
    if (rise) periods.push_back(intervals(edge.time - *rise));
    rise = edge.time;
  }
  SignalStatistics made;
  made.expected = intervals(to - from);
  made.pulses = pulses.size();
  if (pulses.empty()) return made;
  made.pulse_mean = mean_of(pulses);
  made.pulse_deviation = deviation_of(pulses);
  made.period_mean = mean_of(periods);
  made.period_deviation = deviation_of(periods);
  made.irregular = share_off(pulses, 0.5);
  made.off_by_a_tenth = share_off(pulses, 0.1);
  std::sort(pulses.begin(), pulses.end());
  made.pulse_least = pulses.front();
  made.pulse_greatest = pulses.back();
  made.pulse_median = pulses[pulses.size() / 2];
  return made;
}

ReactionTimes reactions(const std::vector<sim::TrueTime>& commands, const std::vector<SignalEdge>& edges,
                        sim::TrueTime from, sim::TrueTime to) {
  ReactionTimes made;
  std::vector<sim::Duration> times;
  auto edge = edges.begin();
  for (std::size_t k = 0; k + 1 < commands.size(); ++k) {
    if (commands[k] < from || commands[k] > to) continue;
    ++made.commands;
    const bool is_high = k % 2 == 0;
    while (edge != edges.end() && (edge->time < commands[k] || edge->is_high != is_high)) ++edge;
    if (edge == edges.end() || edge->time >= commands[k + 1]) continue;
    times.push_back(edge->time - commands[k]);
  }
  made.answered = times.size();
  if (times.empty()) return made;
  std::sort(times.begin(), times.end());
  sim::int128 sum = 0;
  for (const sim::Duration time : times) sum += time.ps();
  made.mean = sim::Duration::from_ps(static_cast<std::int64_t>(sum / static_cast<sim::int128>(times.size())));
  made.p99 = times[(times.size() * 99 + 99) / 100 - 1];
  made.greatest = times.back();
  return made;
}

std::string value_change_dump(const std::vector<SignalEdge>& edges, sim::TrueTime end) {
  std::string text =
      "$timescale 1 ns $end\n$scope module dds-control $end\n$var wire 1 ! output $end\n$upscope $end\n$enddefinitions "
      "$end\n#0\n0!\n";
  for (const SignalEdge& edge : edges) text += fmt::format("#{}\n{}!\n", edge.time.ps() / 1000, edge.is_high ? 1 : 0);
  return text + fmt::format("#{}\n", end.ps() / 1000);
}

}  // namespace takt::papers::coexistence
