#include "chart/xy_chart.hpp"

#include <algorithm>
#include <cmath>

#include "chart/svg.hpp"

namespace takt::chart {
namespace {

constexpr double width = 760;
constexpr double height = 420;
constexpr double left = 80;
constexpr double top = 40;
constexpr double bottom = height - 55;

void draw_axes(Svg& svg, const Frame& frame, const Axis& x, const Axis& y, double right) {
  svg.text({left, 24}, frame.title, {.size = 15, .bold = true});
  for (const Axis::Mark& mark : x.marks()) {
    svg.line({x.pixel(mark.value), top}, {x.pixel(mark.value), bottom}, {.colour = "#eee"});
    svg.text({x.pixel(mark.value), bottom + 18}, mark.text, {.size = 11, .anchor = Anchor::middle});
  }
  for (const Axis::Mark& mark : y.marks()) {
    svg.line({left, y.pixel(mark.value)}, {right, y.pixel(mark.value)}, {.colour = "#eee"});
    svg.text({left - 8, y.pixel(mark.value) + 4}, mark.text, {.size = 11, .anchor = Anchor::end});
  }
  svg.line({left, bottom}, {right, bottom}, {});
  svg.line({left, top}, {left, bottom}, {});
  svg.text({(left + right) / 2, height - 14}, frame.x_label, {.anchor = Anchor::middle});
  svg.text({20, (top + bottom) / 2}, frame.y_label, {.anchor = Anchor::middle, .upright = true});
}

}  // namespace

std::string line_chart(const Frame& frame, const std::vector<Series>& series) {
  constexpr double right = width - 190;   // the legend stands beside
  double least_x = HUGE_VAL;
  double greatest_x = -HUGE_VAL;
  double least_y = frame.y_scale == Scale::linear ? 0 : HUGE_VAL;
  double greatest_y = 0;
  for (const Series& one : series)
    for (const auto& [x, y] : one.points) {
      least_x = std::min(least_x, x);
      greatest_x = std::max(greatest_x, x);
      least_y = std::min(least_y, y);
      greatest_y = std::max(greatest_y, y);
    }
  if (least_x > greatest_x) least_x = 0, greatest_x = 1;
  if (frame.y_scale == Scale::logarithmic) least_y = std::min(least_y, greatest_y) / 1.2;
  const Axis x(frame.x_scale, least_x, greatest_x, left, right);
  const Axis y(frame.y_scale, least_y, greatest_y * 1.05, bottom, top);
  Svg svg(width, height);
  draw_axes(svg, frame, x, y, right);
  double legend = top + 8;
  for (const Series& one : series) {
    const std::string_view colour = palette(one.colour);
    std::vector<Point> points;
    for (const auto& [px, py] : one.points) points.push_back({x.pixel(px), y.pixel(py)});
    svg.polyline(points, {.colour = colour, .width = 2, .dashed = one.dashed});
    for (const Point& point : points) svg.circle(point, 3, one.dashed ? std::string_view("#fff") : colour, colour);
    svg.line({right + 15, legend - 4}, {right + 40, legend - 4}, {.colour = colour, .width = 2, .dashed = one.dashed});
    svg.text({right + 46, legend}, one.name, {.size = 11});
    legend += 18;
  }
  return svg.document();
}

std::string histogram(const Frame& frame, const std::vector<Bar>& bars, double x_least, double x_greatest) {
  constexpr double right = width - 25;
  double least = HUGE_VAL;
  double greatest = 1;
  for (const Bar& bar : bars) {
    least = std::min(least, bar.height);
    greatest = std::max(greatest, bar.height);
  }
  least = std::pow(10, std::floor(std::log10(std::min(least, greatest))));
  const Axis x(frame.x_scale, x_least, x_greatest, left, right);
  const Axis y(Scale::logarithmic, least / 2, greatest * 2, bottom, top);
  Svg svg(width, height);
  draw_axes(svg, frame, x, y, right);
  for (const Bar& bar : bars) {
    const double from = x.pixel(bar.from);
    const double to = x.pixel(bar.to);
    svg.rectangle({from, y.pixel(bar.height)}, std::max(0.5, to - from), bottom - y.pixel(bar.height), palette(0));
  }
  return svg.document();
}

}  // namespace takt::chart
