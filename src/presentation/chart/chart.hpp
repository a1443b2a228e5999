// SPDX-License-Identifier: Apache-2.0
// Charts of a page: plain data that becomes an <svg> element. Its classes want the style sheet of svg.hpp.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "chart/axis.hpp"

namespace takt::chart {

/// A point of a curve, with the ends of its interval if it has one.
struct Sample {
  double x = 0;
  double y = 0;
  std::optional<double> low;
  std::optional<double> high;
};

struct Series {
  std::string name;             ///< empty: no entry in the legend
  std::vector<Sample> samples;  ///< joined in their order, unless they are only marks
  bool is_joined = true;
  std::string colour;     ///< empty: one of the palette
  bool has_marks = true;  ///< at each sample; curves of many samples do without
};

/// What an axis shows.
struct Dimension {
  std::string label;
  Scale scale = Scale::linear;
  std::vector<double> also =
      {};  ///< what the axis takes in besides the chart's figures: 0, a limit, the figures of the charts beside it
};

/// A horizontal line, such as a limit.
struct Rule {
  double y = 0;
  std::string text;
};

/// A vertical line, such as an event.
struct Moment {
  double x = 0;
  std::string text;
};

/// Curves or points over numbers.
struct LineChart {
  std::string title;
  Dimension x;
  Dimension y;
  std::vector<Series> series;
  std::vector<Rule> rules;
  double width = 560;
  double height = 300;
  std::vector<Moment> moments = {};
};
std::string draw(const LineChart& chart);

/// One group of bars for each category, one bar of a group for each name.
struct BarChart {
  std::string title;
  std::vector<std::string> categories;
  std::vector<std::string> names;                        ///< of the bars of a group; one, empty: no legend
  std::vector<std::vector<std::optional<Sample>>> bars;  ///< by category, then name; x is not used; none: no bar
  Dimension y;
  std::vector<Rule> rules;
  double width = 560;
  double height = 300;
};
std::string draw(const BarChart& chart);

/// A cell for each pair of categories, the darker the greater.
struct HeatMap {
  std::string title;
  std::string x_label;
  std::string y_label;
  std::vector<std::string> columns;
  std::vector<std::string> rows;
  std::vector<std::vector<std::optional<double>>> cells;  ///< by row, then column; none: hatched grey
  std::vector<std::vector<bool>> marked;                  ///< cells with a red frame; empty: none
  std::vector<std::vector<std::string>> notes;            ///< what the titles of cells say besides; empty: nothing
  std::string unit;
  bool is_logarithmic = false;
};
std::string draw(const HeatMap& chart);

}  // namespace takt::chart
