#include "chart/histogram.hpp"

#include <algorithm>
#include <cmath>

#include "chart/axis.hpp"
#include "chart/svg.hpp"

namespace takt::chart {
namespace {

constexpr double width = 760;
constexpr double height = 420;
constexpr double left = 80;
constexpr double top = 40;
constexpr double bottom = height - 55;

void draw_axes(Svg& svg, const HistogramTexts& texts, const Axis& x, const Axis& y, double right) {
  svg.text({left, 24}, texts.title, {.size = 15, .bold = true});
  for (const Tick& tick : x.ticks()) {
    svg.line({x.at(tick.value), top}, {x.at(tick.value), bottom}, {.colour = "#eee"});
    svg.text({x.at(tick.value), bottom + 18}, tick.text, {.size = 11, .anchor = Anchor::middle});
  }
  for (const Tick& tick : y.ticks()) {
    svg.line({left, y.at(tick.value)}, {right, y.at(tick.value)}, {.colour = "#eee"});
    svg.text({left - 8, y.at(tick.value) + 4}, tick.text, {.size = 11, .anchor = Anchor::end});
  }
  svg.line({left, bottom}, {right, bottom});
  svg.line({left, top}, {left, bottom});
  svg.text({(left + right) / 2, height - 14}, texts.x_label, {.anchor = Anchor::middle});
  svg.text({20, (top + bottom) / 2}, texts.y_label, {.anchor = Anchor::middle, .upright = true});
}

}  // namespace

std::string histogram(const HistogramTexts& texts, const std::vector<Bar>& bars, double x_least, double x_greatest) {
  constexpr double right = width - 25;
  double least = HUGE_VAL;
  double greatest = 1;
  for (const Bar& bar : bars) {
    least = std::min(least, bar.height);
    greatest = std::max(greatest, bar.height);
  }
  least = std::pow(10, std::floor(std::log10(std::min(least, greatest))));
  const Axis x(Scale::linear, x_least, x_greatest, left, right);
  const Axis y(Scale::logarithmic, least / 2, greatest * 2, bottom, top);
  Svg svg(width, height);
  draw_axes(svg, texts, x, y, right);
  for (const Bar& bar : bars) {
    const double from = x.at(bar.from);
    const double to = x.at(bar.to);
    svg.rectangle({from, y.at(bar.height)}, std::max(0.5, to - from), bottom - y.at(bar.height), ink(0));
  }
  return svg.document();
}

}  // namespace takt::chart
