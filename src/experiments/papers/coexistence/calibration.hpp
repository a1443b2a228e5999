// SPDX-License-Identifier: Apache-2.0
// Response laws from the 1 ms and 5 ms cells of Tables 1 to 8, and what they predict for the others.
#pragma once

#include <array>
#include <vector>

#include "papers/coexistence/published.hpp"
#include "papers/coexistence/response_law.hpp"

namespace takt::papers::coexistence {

/// "≈100%" at 5 ms: no law reaches all of it in finite time. 99.8 % is one miss in 500.
inline constexpr double nearly_all = 99.8;

/// Within how many percentage points the 2 ms cell must be predicted, and what the 10 ms cell must reach.
inline constexpr double tolerance_at_2_ms = 6;
inline constexpr double least_at_10_ms = 93;

FittedLaw calibrate(Law law, const PublishedTable& table);

struct LawErrors {
  Law law = Law::weibull;
  std::array<FittedLaw, tables.size()> fitted;
  std::array<double, tables.size()> at_2_ms = {};   ///< predicted less published, in percentage points
  std::array<double, tables.size()> at_10_ms = {};  ///< predicted, in per cent
  double worst_at_2_ms = 0;                         ///< the greatest error either way
  double rms_at_2_ms = 0;
  double rms_at_10_ms = 0;  ///< against 100 %
  bool fits() const { return worst_at_2_ms <= tolerance_at_2_ms && least() >= least_at_10_ms; }
  double least() const;  ///< of at_10_ms
};

/// One for each of `laws`.
std::vector<LawErrors> compare_laws();

}  // namespace takt::papers::coexistence
