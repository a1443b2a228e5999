// SPDX-License-Identifier: Apache-2.0
#include "chart/chart.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "chart/axis.hpp"
#include "chart/svg.hpp"

namespace takt::chart {
namespace {

constexpr double left = 64;
constexpr double top = 26;
constexpr double right = 26;
constexpr double line_height = 15;

/// The frame that line and bar charts share: title, y axis with its grid, legend below.
struct Frame {
  double width;
  double height;  // of the plot and what stands around it, without the legend
  double bottom;  // room for the x axis
  double x_end() const { return width - right; }
  double y_end() const { return height - bottom; }
};

std::size_t legend_lines(const std::vector<std::string>& names, double width) {
  double x = left;
  std::size_t lines = names.empty() ? 0 : 1;
  for (const std::string& name : names) {
    const double needed = 24 + 6.2 * static_cast<double>(name.size());
    if (x + needed > width && x > left) {
      x = left;
      ++lines;
    }
    x += needed;
  }
  return lines;
}

void draw_legend(Svg& svg, const std::vector<std::string>& names, const std::vector<std::string>& colours, double width,
                 double y) {
  double x = left;
  for (std::size_t i = 0; i < names.size(); ++i) {
    const double needed = 24 + 6.2 * static_cast<double>(names[i].size());
    if (x + needed > width && x > left) {
      x = left;
      y += line_height;
    }
    svg.swatch({x, y - 8}, 9, 9, colours[i]);
    svg.text({x + 13, y}, names[i], Anchor::start, Class{"legend"});
    x += needed;
  }
}

void draw_y(Svg& svg, const Frame& frame, const Axis& axis, const std::string& title, const std::string& label) {
  svg.text({left, 15}, title, Anchor::start, Class{"title"});
  for (const Tick& tick : axis.ticks()) {
    svg.line({left, axis.at(tick.value)}, {frame.x_end(), axis.at(tick.value)}, Class{"grid"});
    svg.text({left - 6, axis.at(tick.value) + 4}, tick.text, Anchor::end, Class{"tick"});
  }
  svg.text({13, (top + frame.y_end()) / 2}, label, Anchor::middle, Class{"label"}, -90);
}

/// Over what the chart shows, else bars would hide them.
void draw_rules(Svg& svg, const Frame& frame, const Axis& axis, const std::vector<Rule>& rules) {
  for (const Rule& rule : rules) {
    if (rule.y < axis.low() || rule.y > axis.high()) continue;
    svg.line({left, axis.at(rule.y)}, {frame.x_end(), axis.at(rule.y)}, Class{"limit"});
    svg.text({frame.x_end(), axis.at(rule.y) - 4}, rule.text, Anchor::end, Class{"note"});
  }
}

/// Texts stand below each other, so that those of moments that are near can be read.
void draw_moments(Svg& svg, const Frame& frame, const Axis& axis, const std::vector<Moment>& moments) {
  double y = top + 10;
  for (const Moment& moment : moments) {
    if (moment.x < axis.low() || moment.x > axis.high()) continue;
    const double x = axis.at(moment.x);
    const bool is_right = x > (left + frame.x_end()) / 2;
    svg.line({x, top}, {x, frame.y_end()}, Class{"limit"});
    svg.text({is_right ? x - 4 : x + 4, y}, moment.text, is_right ? Anchor::end : Anchor::start, Class{"note"});
    y = y + line_height > frame.y_end() ? top + 10 : y + line_height;
  }
}

/// `colour` is that of the curve where several stand side by side.
void draw_whisker(Svg& svg, double x, const Sample& sample, const Axis& y, const std::string& colour = {}) {
  if (!sample.low || !sample.high || *sample.high <= *sample.low) return;
  std::string commands =
      fmt::format("M{} {}V{}", coordinate(x), coordinate(y.at(*sample.low)), coordinate(y.at(*sample.high)));
  for (const double end : {*sample.low, *sample.high})
    commands += fmt::format("M{} {}h6", coordinate(x - 3), coordinate(y.at(end)));
  svg.path(commands, colour.empty() ? std::string(strong) : colour, Class{"whisker"});
}

std::string title_of(const std::string& name, const std::string& x, const Sample& sample) {
  std::string text = (name.empty() ? "" : name + ": ") + x + ": " + number_text(sample.y);
  if (sample.low && sample.high)
    text += fmt::format(" ({} to {})", number_text(*sample.low), number_text(*sample.high));
  return text;
}

void collect(std::vector<double>& values, const Sample& sample) {
  values.push_back(sample.y);
  if (sample.low) values.push_back(*sample.low);
  if (sample.high) values.push_back(*sample.high);
}

}  // namespace

std::string draw(const LineChart& chart) {
  std::vector<double> xs = chart.x.also;
  std::vector<double> ys = chart.y.also;
  std::vector<std::string> names;
  std::vector<std::string> colours;
  std::vector<std::string> legend_colours;
  for (const Series& series : chart.series) {
    for (const Sample& sample : series.samples) {
      xs.push_back(sample.x);
      collect(ys, sample);
    }
    colours.push_back(series.colour.empty() ? std::string(palette(colours.size())) : series.colour);
    if (series.name.empty()) continue;
    names.push_back(series.name);
    legend_colours.push_back(colours.back());
  }
  const double legend_height = line_height * static_cast<double>(legend_lines(names, chart.width));
  const Frame frame{chart.width, chart.height, 40};
  Svg svg(chart.width, chart.height + legend_height + 3);
  const Axis x(xs, chart.x.scale, left, frame.x_end());
  const Axis y(ys, chart.y.scale, frame.y_end(), top);
  draw_y(svg, frame, y, chart.title, chart.y.label);
  svg.line({left, frame.y_end()}, {frame.x_end(), frame.y_end()}, Class{"axis"});
  for (const Tick& tick : x.ticks()) {
    svg.line({x.at(tick.value), frame.y_end()}, {x.at(tick.value), frame.y_end() + 4}, Class{"axis"});
    svg.text({x.at(tick.value), frame.y_end() + 16}, tick.text, Anchor::middle, Class{"tick"});
  }
  svg.text({(left + frame.x_end()) / 2, frame.y_end() + 32}, chart.x.label, Anchor::middle, Class{"label"});
  const bool is_crowded =
      chart.series.size() >
      1;  // whiskers of several curves at one place stand beside each other, each in its curve's colour
  for (std::size_t s = 0; s < chart.series.size(); ++s) {
    const Series& series = chart.series[s];
    const double aside = 4 * (static_cast<double>(s) - static_cast<double>(chart.series.size() - 1) / 2);
    std::string commands;
    for (const Sample& sample : series.samples)
      commands +=
          fmt::format("{}{} {}", commands.empty() ? "M" : "L", coordinate(x.at(sample.x)), coordinate(y.at(sample.y)));
    if (series.is_joined && series.samples.size() > 1) svg.path(commands, colours[s], Class{"curve"});
    for (const Sample& sample : series.samples) {
      if (is_crowded)
        draw_whisker(svg, x.at(sample.x) + aside, sample, y, colours[s]);
      else
        draw_whisker(svg, x.at(sample.x), sample, y);
      if (series.has_marks)
        svg.mark_circle({x.at(sample.x), y.at(sample.y)}, series.is_joined ? 3 : 3.5, colours[s],
                        title_of(series.name, number_text(sample.x), sample));
    }
  }
  draw_rules(svg, frame, y, chart.rules);
  draw_moments(svg, frame, x, chart.moments);
  draw_legend(svg, names, legend_colours, chart.width, chart.height + 9);
  return svg.element(chart.title);
}

std::string draw(const BarChart& chart) {
  std::vector<double> values = chart.y.also;
  if (chart.y.scale == Scale::linear) values.push_back(0);  // the length of a bar is its figure
  for (const auto& group : chart.bars)
    for (const auto& bar : group)
      if (bar) collect(values, *bar);
  std::vector<std::string> names = chart.names;
  if (names.size() == 1 && names.front().empty()) names.clear();
  std::vector<std::string> colours;
  for (std::size_t i = 0; i < names.size(); ++i) colours.emplace_back(palette(i));
  std::size_t longest = 0;
  for (const std::string& category : chart.categories) longest = std::max(longest, category.size());
  const double slot =
      (chart.width - left - right) / static_cast<double>(std::max<std::size_t>(chart.categories.size(), 1));
  const bool is_turned = 6.2 * static_cast<double>(longest) > slot;
  const auto every = static_cast<std::size_t>(std::max(1.0, std::ceil(11 / slot)));
  const double bottom = is_turned ? 12 + 4.5 * static_cast<double>(std::min<std::size_t>(longest, 30)) : 24;
  const Frame frame{chart.width, chart.height + bottom - 24, bottom};
  Svg svg(chart.width, frame.height + line_height * static_cast<double>(legend_lines(names, chart.width)));
  const Axis y(values, chart.y.scale, frame.y_end(), top);
  draw_y(svg, frame, y, chart.title, chart.y.label);
  const double zero = y.is_logarithmic() ? frame.y_end() : y.at(0);
  for (std::size_t c = 0; c < chart.categories.size(); ++c) {
    const double begin = left + slot * (static_cast<double>(c) + 0.1);
    const double width = slot * 0.8 / static_cast<double>(std::max<std::size_t>(chart.bars[c].size(), 1));
    for (std::size_t b = 0; b < chart.bars[c].size(); ++b) {
      if (!chart.bars[c][b]) continue;
      const Sample& sample = *chart.bars[c][b];
      const double x = begin + width * static_cast<double>(b);
      const double end = y.at(sample.y);
      svg.mark_rectangle({x, std::min(end, zero)}, std::max(1.0, width - 1), std::max(0.5, std::abs(zero - end)),
                         palette(b),
                         title_of(chart.names.size() > b ? chart.names[b] : "", chart.categories[c], sample));
      draw_whisker(svg, x + (width - 1) / 2, sample, y);
    }
    const double middle = left + slot * (static_cast<double>(c) + 0.5);
    // Where there is no room for all names, some stand for their neighbours; every bar tells its own when pointed at.
    if (is_turned && c % every != 0) continue;
    if (is_turned)
      svg.text({middle + 4, frame.y_end() + 12}, chart.categories[c].substr(0, 30), Anchor::end, Class{"tick"}, -45);
    else
      svg.text({middle, frame.y_end() + 16}, chart.categories[c], Anchor::middle, Class{"tick"});
  }
  svg.line({left, zero}, {frame.x_end(), zero}, Class{"axis"});
  draw_rules(svg, frame, y, chart.rules);
  draw_legend(svg, names, colours, chart.width, frame.height + 6);
  return svg.element(chart.title);
}

}  // namespace takt::chart
