// SPDX-License-Identifier: Apache-2.0
// How near figures come to their limits: one row for each limit, all on one axis in parts of the limit.
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace takt::chart {

/// Figures as shares of the limit: 1 is the limit.
struct LimitBar {
  std::string name;
  std::string verdict;    ///< at the right
  std::string_view look;  ///< its class: pass, fail or undecided
  std::optional<double> simulated;
  std::optional<double> worst;  ///< the worst that was found
  std::optional<double> bound;
  bool is_upper = true;  ///< figures should stay below the limit, not above
  std::string title;     ///< the figures themselves
};

struct LimitBars {
  std::string title;
  std::vector<LimitBar> bars;
};

std::string draw(const LimitBars& chart);

}  // namespace takt::chart
