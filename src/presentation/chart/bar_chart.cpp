// SPDX-License-Identifier: Apache-2.0
#include "chart/bar_chart.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "chart/axis.hpp"
#include "chart/svg.hpp"

namespace takt::chart {

std::string bar_chart(const std::string& title, const std::string& y_label, const std::vector<std::string>& kinds,
                      const std::vector<BarGroup>& groups) {
  constexpr double left = 80;
  constexpr double top = 60;
  constexpr double height = 470;
  constexpr double bottom = height - 110;
  const double group_width =
      std::clamp(900.0 / static_cast<double>(std::max<std::size_t>(1, groups.size())), 46.0, 120.0);
  const double right = left + group_width * static_cast<double>(groups.size());
  double greatest = 0;
  for (const BarGroup& group : groups)
    for (const LimitedBar& bar : group.bars) greatest = std::max({greatest, bar.value, bar.limit.value_or(0)});
  const Axis y(Scale::linear, 0, greatest * 1.05, bottom, top);
  Svg svg(std::max(right + 30, 640.0), height);
  svg.text({left, 24}, title, Anchor::start, Class{"title"});
  for (const Tick& tick : y.ticks()) {
    svg.line({left, y.at(tick.value)}, {right, y.at(tick.value)}, Class{"grid"});
    svg.text({left - 8, y.at(tick.value) + 4}, tick.text, Anchor::end, Class{"tick"});
  }
  svg.text({20, (top + bottom) / 2}, y_label, Anchor::middle, Class{"label"}, -90);
  double legend = left;
  for (std::size_t k = 0; k < kinds.size(); ++k) {
    svg.swatch({legend, 36}, 12, 12, palette(k));
    svg.text({legend + 17, 46}, kinds[k], Anchor::start, Class{"label"});
    legend += 90;
  }
  const double bar_width = group_width * 0.8 / static_cast<double>(std::max<std::size_t>(1, kinds.size()));
  for (std::size_t g = 0; g < groups.size(); ++g) {
    const double start = left + group_width * (static_cast<double>(g) + 0.1);
    for (std::size_t k = 0; k < groups[g].bars.size(); ++k) {
      const LimitedBar& bar = groups[g].bars[k];
      const double x = start + bar_width * static_cast<double>(k);
      svg.mark_rectangle({x, y.at(bar.value)}, bar_width - 1, bottom - y.at(bar.value), palette(k),
                         fmt::format("{}, {}: {:g}", groups[g].name, kinds[k], bar.value));
      if (bar.limit) svg.line({x - 1, y.at(*bar.limit)}, {x + bar_width, y.at(*bar.limit)}, Class{"limit"});
    }
    // Names of groups, one word below the other.
    double line = bottom + 16;
    std::string_view rest = groups[g].name;
    while (!rest.empty()) {
      const std::size_t space = rest.find(' ');
      svg.text({start + group_width * 0.4, line}, rest.substr(0, space), Anchor::middle, Class{"tick"});
      line += 13;
      rest = space == std::string_view::npos ? std::string_view() : rest.substr(space + 1);
    }
  }
  svg.line({left, bottom}, {right, bottom}, Class{"axis"});
  svg.line({left, top}, {left, bottom}, Class{"axis"});
  return picture(svg.element(title));
}

}  // namespace takt::chart
