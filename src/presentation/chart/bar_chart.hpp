// SPDX-License-Identifier: Apache-2.0
// Groups of bars, each bar with a limit above it.
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace takt::chart {

struct LimitedBar {
  double value = 0;
  std::optional<double> limit;  ///< a line across the bar
};

struct BarGroup {
  std::string name;
  std::vector<LimitedBar> bars;  ///< by kind
};

/// `kinds` names the bars of each group. The axis begins at 0.
std::string bar_chart(const std::string& title, const std::string& y_label, const std::vector<std::string>& kinds,
                      const std::vector<BarGroup>& groups);

}  // namespace takt::chart
