// SPDX-License-Identifier: Apache-2.0
#include "chart/histogram.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "chart/axis.hpp"
#include "chart/svg.hpp"

namespace takt::chart {
namespace {

constexpr double plot_width = 760;
constexpr double plot_height = 420;
constexpr double plot_left = 80;
constexpr double plot_top = 40;
constexpr double plot_bottom = plot_height - 55;

void draw_axes(Svg& svg, const HistogramTexts& texts, const Axis& x, const Axis& y, double right) {
  svg.text({plot_left, 24}, texts.title, Anchor::start, Class{"title"});
  for (const Tick& tick : x.ticks()) {
    svg.line({x.at(tick.value), plot_top}, {x.at(tick.value), plot_bottom}, Class{"grid"});
    svg.text({x.at(tick.value), plot_bottom + 18}, tick.text, Anchor::middle, Class{"tick"});
  }
  for (const Tick& tick : y.ticks()) {
    svg.line({plot_left, y.at(tick.value)}, {right, y.at(tick.value)}, Class{"grid"});
    svg.text({plot_left - 8, y.at(tick.value) + 4}, tick.text, Anchor::end, Class{"tick"});
  }
  svg.line({plot_left, plot_bottom}, {right, plot_bottom}, Class{"axis"});
  svg.line({plot_left, plot_top}, {plot_left, plot_bottom}, Class{"axis"});
  svg.text({(plot_left + right) / 2, plot_height - 14}, texts.x_label, Anchor::middle, Class{"label"});
  svg.text({20, (plot_top + plot_bottom) / 2}, texts.y_label, Anchor::middle, Class{"label"}, -90);
}

}  // namespace

std::string histogram_element(const HistogramTexts& texts, const std::vector<Bar>& bars, double x_least,
                              double x_greatest) {
  constexpr double right = plot_width - 25;
  double least = HUGE_VAL;
  double greatest = 1;
  for (const Bar& bar : bars) {
    least = std::min(least, bar.height);
    greatest = std::max(greatest, bar.height);
  }
  least = std::pow(10, std::floor(std::log10(std::min(least, greatest))));
  const Axis x(Scale::linear, x_least, x_greatest, plot_left, right);
  const Axis y(Scale::logarithmic, least / 2, greatest * 2, plot_bottom, plot_top);
  Svg svg(plot_width, plot_height);
  draw_axes(svg, texts, x, y, right);
  for (const Bar& bar : bars) {
    const double from = x.at(bar.from);
    const double to = x.at(bar.to);
    svg.mark_rectangle({from, y.at(bar.height)}, std::max(0.5, to - from), plot_bottom - y.at(bar.height), palette(0),
                       fmt::format("{:g} to {:g}: {:g}", bar.from, bar.to, bar.height));
  }
  return svg.element(texts.title);
}

std::string histogram(const HistogramTexts& texts, const std::vector<Bar>& bars, double x_least, double x_greatest) {
  return picture(histogram_element(texts, bars, x_least, x_greatest));
}

}  // namespace takt::chart
