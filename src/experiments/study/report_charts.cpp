// SPDX-License-Identifier: Apache-2.0
#include "study/report_charts.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "chart/chart.hpp"
#include "chart/svg.hpp"
#include "study/effects.hpp"

namespace takt::study {
namespace {

constexpr std::size_t most_points_shown = 2000;

/// Levels by their numbers, if they are numbers; as they were written otherwise.
std::vector<std::uint32_t> in_order(const ContentFactor& factor) {
  std::vector<std::uint32_t> order(factor.texts.size());
  std::iota(order.begin(), order.end(), 0u);
  if (factor.is_numeric())
    std::stable_sort(order.begin(), order.end(),
                     [&](std::uint32_t a, std::uint32_t b) { return factor.numbers[a] < factor.numbers[b]; });
  return order;
}

/// How an axis shows a factor's numbers: times in the unit that suits their greatest.
struct Shown {
  double factor = 1;
  std::string label;
};
Shown shown(const ContentFactor& factor) {
  Shown how{1, factor.name + (factor.unit.empty() ? "" : " in " + factor.unit)};
  if (factor.unit != "s" && factor.unit != "bps") return how;
  double greatest = 0;
  for (const double number : factor.numbers) greatest = std::max(greatest, std::abs(number));
  struct Unit {
    const char* base;
    double factor;
    const char* name;
  };
  static constexpr std::array<Unit, 8> units = {{{"s", 1, "s"},
                                                 {"s", 1e-3, "ms"},
                                                 {"s", 1e-6, "us"},
                                                 {"s", 1e-9, "ns"},
                                                 {"bps", 1e9, "Gbps"},
                                                 {"bps", 1e6, "Mbps"},
                                                 {"bps", 1e3, "kbps"},
                                                 {"bps", 1, "bps"}}};
  for (const Unit& unit : units)
    if (factor.unit == unit.base && greatest >= unit.factor * 0.9999999)
      return {1 / unit.factor, factor.name + " in " + unit.name};
  return how;
}

/// Levels that are spread over more than a power of ten and a half, evenly or wider at the end, read better on a
/// logarithmic axis.
chart::Scale scale_of(const ContentFactor& factor) {
  if (factor.is_logarithmic) return chart::Scale::logarithmic;
  const auto [low, high] = std::minmax_element(factor.numbers.begin(), factor.numbers.end());
  return factor.texts.size() > 2 && *low > 0 && *high / *low >= 30 ? chart::Scale::logarithmic : chart::Scale::linear;
}

chart::Sample sample_of(double x, const Summary& summary) {
  chart::Sample sample{x, summary.mean, std::nullopt, std::nullopt};
  if (summary.half_width) {
    sample.low = summary.mean - *summary.half_width;
    sample.high = summary.mean + *summary.half_width;
  }
  return sample;
}

std::vector<chart::Rule> rules_of(const Content& content, std::size_t measure) {
  std::vector<chart::Rule> rules;
  for (const PlannedLimit& limit : content.limits)
    if (limit.measure == measure) rules.push_back({limit.value, limit.text});
  return rules;
}

/// An axis of a measure: from 0 where nothing is below, over all means and intervals of its charts, and to its limits
/// unless they are far away. So charts of one measure can be compared.
chart::Dimension axis_of(const Content& content, std::size_t m) {
  chart::Dimension axis{label_of(content.measures[m]), chart::Scale::linear, {}};
  double low = 0;
  double high = 0;
  const auto take = [&](const Summary& summary) {
    if (summary.count == 0) return;
    low = std::min(low, summary.mean - summary.half_width.value_or(0));
    high = std::max(high, summary.mean + summary.half_width.value_or(0));
  };
  for (std::size_t f = 0; f < content.factors.size(); ++f)
    for (const Summary& summary : main_effect(content, f, m)) take(summary);
  constexpr double far = 3;  // times what was found
  for (const PlannedLimit& limit : content.limits)
    if (limit.measure == m && std::abs(limit.value) <= far * std::max(std::abs(low), std::abs(high))) {
      low = std::min(low, limit.value);
      high = std::max(high, limit.value);
    }
  axis.also = {low, high};
  return axis;
}

chart::Series curve_of(const ContentFactor& factor, const std::vector<Summary>& summaries, double scale,
                       std::string name) {
  chart::Series series;
  series.name = std::move(name);
  for (const std::uint32_t level : in_order(factor))
    if (summaries[level].count > 0)
      series.samples.push_back(sample_of(factor.numbers[level] * scale, summaries[level]));
  return series;
}

/// Every n-th, so that a page stays small.
chart::Series cloud_of(const ContentFactor& factor, const std::vector<Summary>& summaries, double scale) {
  chart::Series series = curve_of(factor, summaries, scale, "");
  series.is_joined = false;
  const std::size_t step = (series.samples.size() + most_points_shown - 1) / most_points_shown;
  if (step > 1) {
    std::vector<chart::Sample> fewer;
    for (std::size_t i = 0; i < series.samples.size(); i += step) fewer.push_back(series.samples[i]);
    series.samples = std::move(fewer);
  }
  return series;
}

}  // namespace

std::string label_of(const ContentMeasure& measure) {
  return measure.name + (measure.unit.empty() ? "" : " in " + measure.unit);
}

std::string main_effect_chart(const Content& content, std::size_t f, std::size_t m) {
  const ContentFactor& factor = content.factors[f];
  const ContentMeasure& measure = content.measures[m];
  const std::vector<Summary> summaries = main_effect(content, f, m);
  const std::string title = measure.name + " by " + factor.name;
  if (factor.is_numeric() && factor.texts.size() > 2) {
    const Shown how = shown(factor);
    chart::LineChart line;
    line.title = title;
    line.x = {how.label, scale_of(factor)};
    line.y = axis_of(content, m);
    line.series = {factor.texts.size() > most_levels_shown ? cloud_of(factor, summaries, how.factor)
                                                           : curve_of(factor, summaries, how.factor, "")};
    line.rules = rules_of(content, m);
    line.width = 420;
    line.height = 240;
    return line.series.front().samples.empty() ? "" : draw(line);
  }
  chart::BarChart bars;
  bars.title = title;
  bars.names = {""};
  bars.y = axis_of(content, m);
  bars.rules = rules_of(content, m);
  bars.width = 420;
  bars.height = 240;
  for (const std::uint32_t level : in_order(factor)) {
    if (bars.categories.size() == most_levels_shown) break;
    if (summaries[level].count == 0) continue;
    bars.categories.push_back(factor.texts[level]);
    bars.bars.push_back({sample_of(0, summaries[level])});
  }
  return bars.categories.empty() ? "" : draw(bars);
}

std::string response_chart(const Content& content, std::size_t x, std::size_t curves, std::size_t m) {
  const ContentFactor& factor = content.factors[x];
  const ContentFactor& other = content.factors[curves];
  constexpr std::size_t most_curves = 8;
  if (!factor.is_numeric() || factor.texts.size() < 2 || factor.texts.size() > most_levels_shown ||
      other.texts.size() < 2 || other.texts.size() > most_curves)
    return {};
  if (!are_crossed(content, x, curves)) return {};
  const auto effect = joint_effect(content, curves, x, m);
  const Shown how = shown(factor);
  chart::LineChart line;
  line.title = content.measures[m].name + " over " + factor.name + ", by " + other.name;
  line.x = {how.label, scale_of(factor)};
  line.y = axis_of(content, m);
  line.rules = rules_of(content, m);
  for (const std::uint32_t level : in_order(other)) {
    line.series.push_back(curve_of(factor, effect[level], how.factor, other.name + " = " + other.texts[level]));
    if (line.series.back().samples.empty()) line.series.pop_back();
  }
  return line.series.empty() ? "" : draw(line);
}

std::string heat_map_chart(const Content& content, std::size_t rows, std::size_t columns, std::size_t m) {
  constexpr std::size_t most_cells_each_way = 24;
  const ContentFactor& down = content.factors[rows];
  const ContentFactor& across = content.factors[columns];
  for (const ContentFactor* factor : {&down, &across})
    if (factor->texts.size() < 2 || factor->texts.size() > most_cells_each_way) return {};
  if (!are_crossed(content, rows, columns)) return {};
  const auto effect = joint_effect(content, rows, columns, m);
  // The first point of each cell that does not pass.
  std::vector<std::vector<std::optional<std::uint64_t>>> breaks(
      down.texts.size(), std::vector<std::optional<std::uint64_t>>(across.texts.size()));
  for (std::size_t row = 0; row < content.rows(); ++row) {
    const Variant& variant = content.variants[content.variant[row]];
    std::optional<std::uint64_t>& first = breaks[variant[rows]][variant[columns]];
    if (!content.passes[row] && !first) first = content.point_of(row);
  }
  chart::HeatMap map;
  map.title = content.measures[m].name + " by " + down.name + " and " + across.name;
  map.x_label = across.name;
  map.y_label = down.name;
  map.unit = content.measures[m].unit;
  double low = INFINITY;
  double high = 0;
  for (const std::uint32_t column : in_order(across)) map.columns.push_back(across.texts[column]);
  for (const std::uint32_t row : in_order(down)) {
    map.rows.push_back(down.texts[row]);
    map.cells.emplace_back();
    map.marked.emplace_back();
    map.notes.emplace_back();
    for (const std::uint32_t column : in_order(across)) {
      const Summary& summary = effect[row][column];
      map.cells.back().push_back(summary.count > 0 ? std::optional(summary.mean) : std::nullopt);
      const std::optional<std::uint64_t>& broken = breaks[row][column];
      map.marked.back().push_back(broken.has_value());
      map.notes.back().push_back(
          broken ? fmt::format("point {} does not pass: takt study shrink FILE {} --out worst.json", *broken, *broken)
                 : std::string());
      if (summary.count == 0) continue;
      low = std::min(low, summary.mean);
      high = std::max(high, summary.mean);
    }
  }
  if (!(low <= high)) return {};
  map.is_logarithmic = low > 0 && high / low > 30;
  return draw(map);
}

std::string pareto_chart(const Content& content, std::size_t a, std::size_t b) {
  const std::vector<std::uint32_t> front = pareto_front(content, a, b);
  if (front.empty()) return {};
  const std::vector<Summary> of_a = by_variant(content, a);
  const std::vector<Summary> of_b = by_variant(content, b);
  chart::Series all{"variants", {}, false, std::string(chart::faint)};
  const std::size_t step = std::max<std::size_t>(1, content.variants.size() / most_points_shown);
  for (std::size_t v = 0; v < content.variants.size(); v += step)
    if (of_a[v].count > 0 && of_b[v].count > 0)
      all.samples.push_back({of_a[v].mean, of_b[v].mean, std::nullopt, std::nullopt});
  chart::Series best{"Pareto front", {}, true, std::string(chart::palette(1))};
  for (const std::uint32_t v : front) best.samples.push_back({of_a[v].mean, of_b[v].mean, std::nullopt, std::nullopt});
  chart::LineChart line;
  line.title = content.measures[a].name + " against " + content.measures[b].name;
  line.x = {label_of(content.measures[a])};
  line.y = {label_of(content.measures[b])};
  line.series = {std::move(all), std::move(best)};
  return draw(line);
}

std::string pass_chart(const Content& content, std::size_t f) {
  const ContentFactor& factor = content.factors[f];
  if (factor.texts.size() < 2 || factor.texts.size() > most_levels_shown) return {};
  std::vector<double> good(factor.texts.size(), 0);
  std::vector<double> all(factor.texts.size(), 0);
  const auto passes = variants_that_pass(content);
  for (std::uint32_t v = 0; v < content.variants.size(); ++v) {
    if (!passes[v]) continue;
    all[content.variants[v][f]] += 1;
    good[content.variants[v][f]] += *passes[v] ? 1 : 0;
  }
  chart::BarChart bars;
  bars.title = "variants that pass, by " + factor.name;
  bars.names = {""};
  bars.y = {"%"};
  bars.width = 420;
  bars.height = 220;
  for (const std::uint32_t level : in_order(factor)) {
    if (all[level] == 0) continue;
    bars.categories.push_back(factor.texts[level]);
    bars.bars.push_back({chart::Sample{0, 100 * good[level] / all[level], std::nullopt, std::nullopt}});
  }
  return bars.categories.empty() ? "" : draw(bars);
}

}  // namespace takt::study
