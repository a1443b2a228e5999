// SPDX-License-Identifier: Apache-2.0
#include "chart/limit_bars.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "chart/axis.hpp"
#include "chart/svg.hpp"

namespace takt::chart {
namespace {

constexpr double bars_left = 330;
constexpr double bars_width = 1000;
constexpr double bars_right = 100;  // for the verdict
constexpr double row_height = 30;
constexpr double bars_top = 44;

/// The axis shows a little more than the limit; what lies beyond ends in an arrow.
double greatest_of(const LimitBars& chart) {
  double greatest = 1.1;
  for (const LimitBar& bar : chart.bars)
    for (const std::optional<double>& share : {bar.simulated, bar.worst, bar.bound})
      greatest = std::max(greatest, share.value_or(0) * 1.05);
  return std::min(greatest, 2.0);
}

/// Long names end in dots; the whole one is shown with the figures.
std::string shortened(const std::string& name) {
  constexpr std::size_t most = 54;
  return name.size() <= most ? name : name.substr(0, most - 3) + "...";
}

}  // namespace

std::string draw(const LimitBars& chart) {
  const double bottom = bars_top + row_height * static_cast<double>(chart.bars.size());
  Svg svg(bars_width, bottom + 24);
  const Axis x(Scale::linear, 0, 100 * greatest_of(chart), bars_left, bars_width - bars_right);
  const auto at = [&](double share) { return x.at(100 * share); };
  svg.text({8, 18}, chart.title, Anchor::start, Class{"title"});
  struct Key {
    std::string_view text;
    std::string_view colour;
  };
  constexpr std::array<Key, 3> keys = {
      {{"simulated", "#0072b2"}, {"worst found", "#56b4e9"}, {"at most (bound)", "#d55e00"}}};
  for (std::size_t i = 0; i < keys.size(); ++i) {
    svg.swatch({bars_left + 130 * static_cast<double>(i), 24}, 14, i == 2 ? 3 : 9, keys[i].colour);
    svg.text({bars_left + 130 * static_cast<double>(i) + 19, 32}, keys[i].text, Anchor::start, Class{"label"});
  }
  for (const Tick& tick : x.ticks()) {
    svg.line({x.at(tick.value), bars_top}, {x.at(tick.value), bottom}, Class{"grid"});
    svg.text({x.at(tick.value), bottom + 15}, tick.text + " %", Anchor::middle, Class{"label"});
  }
  svg.text({bars_left - 26, bottom + 15}, "of the limit", Anchor::end, Class{"label"});
  for (std::size_t i = 0; i < chart.bars.size(); ++i) {
    const LimitBar& bar = chart.bars[i];
    const double y = bars_top + row_height * static_cast<double>(i);
    const std::string title = bar.name + ": " + bar.title;
    svg.text({bars_left - 10, y + 19}, shortened(bar.name), Anchor::end, Class{"label"});
    svg.text({bars_width - bars_right + 10, y + 19}, bar.verdict, Anchor::start, Class{bar.look});
    if (bar.worst) svg.mark_rectangle({bars_left, y + 8}, at(*bar.worst) - bars_left, 14, keys[1].colour, title);
    if (bar.simulated)
      svg.mark_rectangle({bars_left, y + 11}, std::max(at(*bar.simulated) - bars_left, 1.0), 8, keys[0].colour, title);
    if (bar.bound) {
      svg.mark_rectangle({bars_left, y + 14}, at(*bar.bound) - bars_left, 2, keys[2].colour, title);
      svg.mark_rectangle({at(*bar.bound) - 1.5, y + 6}, 3, 18, keys[2].colour, title);
    }
    for (const std::optional<double>& share : {bar.simulated, bar.worst, bar.bound})
      if (share && *share * 100 > x.high())
        svg.text({bars_width - bars_right - 4, y + 8}, fmt::format("{:.0f} %", 100 * *share), Anchor::end,
                 Class{"note"});
  }
  svg.line({at(1), bars_top - 6}, {at(1), bottom}, Class{"limit"});
  return svg.element(chart.title);
}

}  // namespace takt::chart
