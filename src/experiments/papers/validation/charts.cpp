// SPDX-License-Identifier: Apache-2.0
#include "papers/validation/charts.hpp"

#include <algorithm>
#include <map>
#include <optional>
#include <set>
#include <utility>

#include "chart/chart.hpp"
#include "chart/svg.hpp"

namespace takt::papers::validation {
namespace {

using chart::LineChart;
using chart::Sample;
using chart::Series;

Figure ratios(const Validation& made) {
  LineChart chart;
  chart.title =
      "takt's figures as multiples of the published ones (those that must be at most or at least that much stand "
      "apart)";
  chart.x.label = "figures, by source";
  chart.y = {"takt / published", chart::Scale::logarithmic};
  chart.rules = {{1, "the same"}};
  chart.width = 900;
  chart.height = 380;
  double x = 0;
  for (std::size_t s = 0; s < made.sources.size(); ++s) {
    Series series{made.sources[s].name, {}, false, ""};
    for (const Judged& each : made.figures) {
      if (each.source != s) continue;
      ++x;
      if (each.takt_value && each.published_value && *each.published_value > 0 && *each.takt_value > 0)
        series.samples.push_back({x, *each.takt_value / *each.published_value, {}, {}});
    }
    chart.series.push_back(std::move(series));
  }
  return {"ratios", chart::picture(draw(chart))};
}

/// The place of each row: from the least to the greatest by what is published.
std::map<std::string, double> places_of(const std::vector<const Judged*>& figures) {
  std::map<std::string, double> greatest;
  for (const Judged* each : figures)
    if (each->published_value) greatest[each->row] = std::max(greatest[each->row], *each->published_value);
  std::vector<std::pair<double, std::string>> order;
  for (const auto& [row, value] : greatest) order.emplace_back(value, row);
  std::sort(order.begin(), order.end());
  std::map<std::string, double> places;
  for (std::size_t i = 0; i < order.size(); ++i) places[order[i].second] = static_cast<double>(i + 1);
  return places;
}

/// A curve that is broken where rows have no figure.
void add_curve(LineChart& chart, const std::string& name, const std::string& colour, std::vector<Sample> samples) {
  std::sort(samples.begin(), samples.end(), [](const Sample& a, const Sample& b) { return a.x < b.x; });
  std::optional<double> last;
  for (const Sample& sample : samples) {
    if (!last || sample.x > *last + 1) chart.series.push_back({last ? "" : name, {}, true, colour});
    chart.series.back().samples.push_back(sample);
    last = sample.x;
  }
}

/// What is published in marks, what takt says a curve for each kind of figure.
Figure rows_of(const Validation& made, std::size_t source) {
  std::vector<const Judged*> figures;
  std::vector<std::string> kinds;  // in their order
  for (const Judged& each : made.figures) {
    if (each.source != source || each.row.empty()) continue;
    figures.push_back(&each);
    if (std::find(kinds.begin(), kinds.end(), each.kind) == kinds.end()) kinds.push_back(each.kind);
  }
  const std::map<std::string, double> places = places_of(figures);
  LineChart chart;
  chart.title = made.sources[source].name;
  chart.x.label = "rows of the table, by the greatest published figure";
  chart.y = {figures.front()->unit, chart::Scale::logarithmic};
  chart.width = 900;
  chart.height = 460;
  std::set<std::pair<double, double>> published;  // several figures may be held against one
  for (const Judged* each : figures)
    if (each->published_value) published.insert({places.at(each->row), *each->published_value});
  for (std::size_t k = 0; k < kinds.size(); ++k) {
    std::vector<Sample> samples;
    for (const Judged* each : figures)
      if (each->kind == kinds[k] && each->takt_value)
        samples.push_back({places.at(each->row), *each->takt_value, {}, {}});
    add_curve(chart, "takt: " + kinds[k], std::string(chart::palette(k)), std::move(samples));
  }
  Series marks{"published", {}, false, std::string(chart::strong)};
  for (const auto& [x, y] : published) marks.samples.push_back({x, y, {}, {}});
  chart.series.push_back(std::move(marks));
  return {made.sources[source].id, chart::picture(draw(chart))};
}

}  // namespace

std::vector<Figure> draw_charts(const Validation& made) {
  std::vector<Figure> pictures = {ratios(made)};
  for (std::size_t s = 0; s < made.sources.size(); ++s)
    if (std::any_of(made.figures.begin(), made.figures.end(),
                    [s](const Judged& each) { return each.source == s && !each.row.empty(); }))
      pictures.push_back(rows_of(made, s));
  return pictures;
}

}  // namespace takt::papers::validation
