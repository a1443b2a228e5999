// Lines and bars over an axis.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "chart/axis.hpp"

namespace takt::chart {

struct Frame {
  std::string title;
  std::string x_label;
  std::string y_label;
  Scale x_scale = Scale::linear;
  Scale y_scale = Scale::linear;
};

struct Series {
  std::string name;
  std::vector<std::pair<double, double>> points;   ///< ascending x
  bool dashed = false;
  std::size_t colour = 0;                          ///< number in the palette
};

/// A line for each series, with marks at its points.
std::string line_chart(const Frame& frame, const std::vector<Series>& series);

struct Bar {
  double from = 0;
  double to = 0;
  double height = 0;   ///< above 0
};

/// Bars from the bottom of a logarithmic axis; `x_least` to `x_greatest` is shown.
std::string histogram(const Frame& frame, const std::vector<Bar>& bars, double x_least, double x_greatest);

}  // namespace takt::chart
