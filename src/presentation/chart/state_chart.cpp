// SPDX-License-Identifier: Apache-2.0
#include "chart/state_chart.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "chart/svg.hpp"

namespace takt::chart {
namespace {

constexpr double half_width = 62;
constexpr double half_height = 24;

/// Where the line from the centre of a box towards `target` leaves it.
Point edge_of(const StateBox& box, Point target) {
  const double dx = target.x - box.x;
  const double dy = target.y - box.y;
  const double scale =
      std::min(dx == 0 ? HUGE_VAL : half_width / std::abs(dx), dy == 0 ? HUGE_VAL : half_height / std::abs(dy));
  return {box.x + dx * scale, box.y + dy * scale};
}

}  // namespace

std::string state_chart(const std::string& title, const std::vector<StateBox>& states,
                        const std::vector<TransitionArc>& arcs, double width, double height) {
  Svg svg(width, height);
  svg.text({20, 26}, title, Anchor::start, Class{"title"});
  for (const TransitionArc& arc : arcs) {
    const StateBox& a = states[arc.from];
    const StateBox& b = states[arc.to];
    const double length = std::hypot(b.x - a.x, b.y - a.y);
    const double bow = 46;  // to the right of the way, so that there and back lie apart
    const Point control{(a.x + b.x) / 2 - (b.y - a.y) / length * bow, (a.y + b.y) / 2 + (b.x - a.x) / length * bow};
    const Point from = edge_of(a, control);
    const Point to = edge_of(b, control);
    svg.path(fmt::format("M{} {}Q{} {} {} {}", coordinate(from.x), coordinate(from.y), coordinate(control.x),
                         coordinate(control.y), coordinate(to.x), coordinate(to.y)),
             {}, Class{arc.dashed ? "arrow dashed" : "arrow"});
    const Point label{(a.x + b.x) / 4 + control.x / 2, (a.y + b.y) / 4 + control.y / 2};
    svg.rectangle({label.x - 3.6 * static_cast<double>(arc.text.size()), label.y - 9},
                  7.2 * static_cast<double>(arc.text.size()), 16, Class{"paper"});
    svg.text({label.x, label.y + 4}, arc.text, Anchor::middle, Class{"label"});
  }
  for (const StateBox& state : states) {
    svg.rectangle({state.x - half_width, state.y - half_height}, 2 * half_width, 2 * half_height, Class{"box"}, 10);
    svg.text({state.x, state.y + 5}, state.name, Anchor::middle, Class{"strong"});
  }
  return picture(svg.element(title));
}

}  // namespace takt::chart
