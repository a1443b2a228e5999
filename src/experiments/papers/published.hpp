// SPDX-License-Identifier: Apache-2.0
// What "Real-time capable OPC-UA Programs over TSN for distributed industrial control" (Eymueller et al., 2020)
// publishes in figures.
#pragma once

#include <array>

namespace takt::papers {

/// A row of Table I: round trips in milliseconds at a cycle of 200 us, over an hour.
struct PublishedRoundTrip {
  int values = 0;
  double average = 0;
  double greatest = 0;
  double deviation = 0;
};

inline constexpr std::array<PublishedRoundTrip, 5> table_1 = {{
    {1, 0.268, 0.310, 0.01030},
    {5, 0.285, 0.344, 0.01057},
    {10, 0.304, 0.386, 0.01011},
    {15, 0.338, 0.559, 0.00981},
    {20, 0.369, 0.639, 0.01190},
}};

/// Section VI: to be expected for one way, in milliseconds.
inline constexpr double one_way = 0.4;
/// Section V: six values each way within this, in milliseconds.
inline constexpr double robot_deadline = 1.0;

}  // namespace takt::papers
