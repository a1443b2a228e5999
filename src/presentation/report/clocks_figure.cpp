// SPDX-License-Identifier: Apache-2.0
#include "report/clocks_figure.hpp"

#include <algorithm>
#include <cstdlib>
#include <utility>

namespace takt::report {

ClockCurves::ClockCurves(const scenario::Run& run, const results::RunResult& result)
    : run_(&run), result_(&result), begin_(begin_of(result)), end_(sim::TrueTime() + result.simulated) {}

/// Clocks that are still far off would leave no room for the others: the picture begins when figures count, or when
/// most are locked.
sim::TrueTime ClockCurves::begin_of(const results::RunResult& result) {
  if (result.from > sim::Duration() && result.from < result.simulated) return sim::TrueTime() + result.from;
  std::vector<sim::Duration> locked;
  for (const results::ClockResult& clock : result.clocks)
    if (clock.time_to_lock) locked.push_back(*clock.time_to_lock);
  if (locked.empty()) return {};
  std::ranges::sort(locked);
  return sim::TrueTime() + std::min(locked[locked.size() / 2] * 2, result.simulated / 2);
}

void ClockCurves::sample(const scenario::ClockSample& sample) {
  if (sample.time < begin_) return;
  if (!look_.empty() && look_.front().time != sample.time) record_sample();
  look_.push_back(sample);
}

void ClockCurves::record_sample() {
  if (look_.empty()) return;
  std::map<std::uint32_t, std::size_t> followers;
  for (const scenario::ClockSample& each : look_) ++followers[each.grandmaster.value];
  const std::uint32_t leader =
      std::ranges::max_element(followers, {}, [](const auto& each) { return each.second; })->first;
  const scenario::ClockSample& one =
      *std::ranges::find_if(look_, [&](const auto& each) { return each.grandmaster.value == leader; });
  const std::int64_t time_of_leader = (one.true_offset - one.offset).ps();
  const auto whole = static_cast<double>((end_ - begin_).ps());
  const double share = whole > 0 ? static_cast<double>((look_.front().time - begin_).ps()) / whole : 0;
  const std::size_t column = std::min(columns - 1, static_cast<std::size_t>(share * columns));
  for (const scenario::ClockSample& each : look_) {
    std::vector<Extent>& curve = curves_[each.node.value];
    curve.resize(columns);
    const std::int64_t offset = each.true_offset.ps() - time_of_leader;
    Extent& extent = curve[column];
    extent = extent.is_empty ? Extent{false, offset, offset}
                             : Extent{false, std::min(extent.low, offset), std::max(extent.high, offset)};
  }
  look_.clear();
}

std::optional<chart::LineChart> ClockCurves::figure() const {
  if (curves_.empty()) return std::nullopt;
  struct Curve {
    std::uint32_t node = 0;
    std::int64_t greatest = 0;
  };
  std::vector<Curve> order;
  for (const auto& [node, curve] : curves_) {
    std::int64_t greatest = 0;
    for (const Extent& extent : curve)
      if (!extent.is_empty) greatest = std::max({greatest, std::abs(extent.low), std::abs(extent.high)});
    order.push_back({node, greatest});
  }
  std::ranges::stable_sort(order, std::ranges::greater(), &Curve::greatest);
  const bool is_cut = order.size() > most_curves;
  if (is_cut) order.resize(most_curves);
  const bool in_us = order.front().greatest >= 10'000'000;
  const double unit = in_us ? 1e6 : 1e3;
  chart::LineChart chart;
  chart.title = is_cut ? "Offsets from the grandmaster that most nodes follow: the clocks that are farthest off"
                       : "Offsets from the grandmaster that most nodes follow";
  chart.x.label = "s";
  chart.y.label = in_us ? "us" : "ns";
  chart.y.also = {0};
  chart.width = 860;
  const double seconds_a_column = static_cast<double>((end_ - begin_).ps()) * 1e-12 / columns;
  const double first = static_cast<double>(begin_.ps()) * 1e-12;
  chart.x.also = {first, first + seconds_a_column * columns};
  for (const Curve& each : order) {
    chart::Series series;
    series.name = run_->network().plan().nodes[each.node].name;
    series.has_marks = false;
    const std::vector<Extent>& curve = curves_.at(each.node);
    for (std::size_t c = 0; c < curve.size(); ++c) {
      if (curve[c].is_empty) continue;
      const double x = first + seconds_a_column * (static_cast<double>(c) + 0.5);
      series.samples.push_back({x, static_cast<double>(curve[c].low) / unit, {}, {}});
      if (curve[c].high != curve[c].low)
        series.samples.push_back({x, static_cast<double>(curve[c].high) / unit, {}, {}});
    }
    chart.series.push_back(std::move(series));
  }
  constexpr std::size_t most_moments = 12;
  for (const results::GrandmasterResult& each : result_->grandmasters)
    if (chart.moments.size() < most_moments)
      chart.moments.push_back({static_cast<double>(each.at.ps()) * 1e-12, each.node + " " + each.event});
  return chart;
}

}  // namespace takt::report
