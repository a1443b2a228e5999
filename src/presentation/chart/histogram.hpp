// SPDX-License-Identifier: Apache-2.0
// Bars over an axis of figures.
#pragma once

#include <string>
#include <vector>

namespace takt::chart {

struct HistogramTexts {
  std::string title;
  std::string x_label;
  std::string y_label;
};

struct Bar {
  double from = 0;
  double to = 0;
  double height = 0;  ///< above 0
};

/// Bars from the bottom of a logarithmic axis; `x_least` to `x_greatest` is shown.
std::string histogram(const HistogramTexts& texts, const std::vector<Bar>& bars, double x_least, double x_greatest);
/// The same as an element of a page.
std::string histogram_element(const HistogramTexts& texts, const std::vector<Bar>& bars, double x_least,
                              double x_greatest);

}  // namespace takt::chart
