// SPDX-License-Identifier: Apache-2.0
#include "chart/square_wave.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "chart/axis.hpp"
#include "chart/svg.hpp"

namespace takt::chart {
namespace {

constexpr int divisions = 10;
constexpr double traces_left = 90;
constexpr double traces_top = 40;
constexpr double traces_width = 800;
constexpr double trace_height = 110;
constexpr double swing = 60;  // between low and high

std::vector<Point> line_of(const Trace& trace, const Axis& time, double low) {
  const auto level = [low](bool is_high) { return is_high ? low - swing : low; };
  bool is_high = !trace.edges.empty() && !trace.edges.front().is_high;
  auto next = trace.edges.begin();
  for (; next != trace.edges.end() && next->time <= time.low(); ++next) is_high = next->is_high;
  std::vector<Point> points = {{time.at(time.low()), level(is_high)}};
  for (; next != trace.edges.end() && next->time < time.high(); ++next) {
    if (next->is_high == is_high) continue;
    points.push_back({time.at(next->time), level(is_high)});
    is_high = next->is_high;
    points.push_back({time.at(next->time), level(is_high)});
  }
  points.push_back({time.at(time.high()), level(is_high)});
  return points;
}

}  // namespace

std::string draw(const SquareWaves& waves) {
  const double height = trace_height * static_cast<double>(std::max<std::size_t>(waves.traces.size(), 1));
  const Axis time(Scale::linear, waves.from, waves.from + divisions * waves.division, traces_left,
                  traces_left + traces_width);
  Svg svg(traces_left + traces_width + 30, traces_top + height + 50);
  svg.text({traces_left, 26}, waves.title, Anchor::start, Class{"title"});
  svg.rectangle({traces_left, traces_top}, traces_width, height, Class{"screen"}, 4);
  for (int i = 1; i < divisions; ++i) {
    const double x = traces_left + traces_width * i / divisions;
    svg.line({x, traces_top}, {x, traces_top + height}, Class{"screen-grid"});
  }
  for (std::size_t i = 0; i < waves.traces.size(); ++i) {
    const double low = traces_top + trace_height * static_cast<double>(i) + 85;
    if (i > 0) svg.line({traces_left, low - 85}, {traces_left + traces_width, low - 85}, Class{"screen-grid"});
    svg.text({traces_left - 8, low - swing / 2 + 4}, waves.traces[i].name, Anchor::end, Class{"label"});
    svg.polyline(line_of(waves.traces[i], time, low), screen_palette(i), Class{"curve"});
  }
  svg.text({traces_left, traces_top + height + 18}, fmt::format("{:g} {} a division", waves.division, waves.unit),
           Anchor::start, Class{"label"});
  svg.text({traces_left, traces_top + height + 36}, waves.note, Anchor::start, Class{"note"});
  return picture(svg.element(waves.title));
}

}  // namespace takt::chart
