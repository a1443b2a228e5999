// SPDX-License-Identifier: Apache-2.0
#include "chart/gantt.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "chart/axis.hpp"
#include "chart/svg.hpp"

namespace takt::chart {

namespace {

/// Names of rows have the room that the longest one takes, up to a limit beyond which they end in dots.
constexpr std::size_t longest_name = 64;
constexpr double of_character = 6.2;

std::string shown_name(const std::string& name) {
  return name.size() <= longest_name ? name : name.substr(0, longest_name - 3) + "...";
}

double room_for_names(const Gantt& chart) {
  std::size_t longest = 0;
  for (const GanttRow& row : chart.rows) longest = std::max(longest, shown_name(row.name).size());
  return std::max(190.0, 16 + of_character * static_cast<double>(longest));
}

}  // namespace

std::string draw(const Gantt& chart) {
  const double left = room_for_names(chart);
  constexpr double width = 1080;
  constexpr double row_height = 20;
  constexpr double head = 34;
  constexpr double entry_width = 215;
  constexpr std::size_t a_line = 4;
  const double bottom = head + row_height * static_cast<double>(chart.rows.size());
  const double legend = 16 * static_cast<double>((chart.legend.size() + a_line - 1) / a_line);
  Svg svg(width, bottom + 30 + legend);
  svg.text({8, 18}, chart.title, Anchor::start, Class{"title"});
  const Axis x(Scale::linear, chart.from, chart.to, left, width - 14);
  for (const Tick& tick : x.ticks()) {
    svg.line({x.at(tick.value), head}, {x.at(tick.value), bottom}, Class{"grid"});
    svg.text({x.at(tick.value), bottom + 14}, tick.text, Anchor::middle, Class{"label"});
  }
  svg.text({left - 8, bottom + 14}, chart.unit, Anchor::end, Class{"label"});
  for (std::size_t r = 0; r < chart.rows.size(); ++r) {
    const GanttRow& row = chart.rows[r];
    const double y = head + row_height * static_cast<double>(r);
    svg.text({left - 8, y + 14}, shown_name(row.name), Anchor::end, Class{"label"});
    svg.line({left, y + row_height}, {width - 14, y + row_height}, Class{"grid"});
    for (const GanttStretch& stretch : row.stretches)
      svg.rectangle({x.at(stretch.from), y + 2}, x.at(stretch.to) - x.at(stretch.from), row_height - 4,
                    Class{"stretch"});
    // What would be narrower than a pixel can be seen all the same.
    for (const GanttBar& bar : row.bars)
      svg.mark_rectangle({x.at(bar.from), y + 5}, std::max(x.at(bar.to) - x.at(bar.from), 1.0), row_height - 10,
                         palette(bar.colour), bar.title);
    for (const GanttCross& cross : row.crosses) {
      const double at = x.at(cross.at);
      svg.titled_path(fmt::format("M{0} {2} L{1} {3} M{0} {3} L{1} {2}", coordinate(at - 4), coordinate(at + 4),
                                  coordinate(y + 6), coordinate(y + 14)),
                      "#c0392b", 2, cross.title);
    }
  }
  for (std::size_t i = 0; i < chart.legend.size(); ++i) {
    const Point at{left + entry_width * static_cast<double>(i % a_line),
                   bottom + 26 + 16 * static_cast<double>(i / a_line)};
    svg.swatch({at.x, at.y - 2}, 12, 9, palette(i));
    svg.text({at.x + 17, at.y + 7}, chart.legend[i], Anchor::start, Class{"label"});
  }
  return svg.element(chart.title);
}

}  // namespace takt::chart
