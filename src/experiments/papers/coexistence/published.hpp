// SPDX-License-Identifier: Apache-2.0
// What "DDS and OPC UA Protocol Coexistence Solution in Real-Time and Industry 4.0 Context Using Non-Ideal
// Infrastructure" (2021) publishes in figures.
#pragma once

#include <array>
#include <cstddef>
#include <string_view>

namespace takt::papers::coexistence {

/// The intervals at which the threads are due, in ms, as the columns of Tables 1 to 8.
inline constexpr std::array<int, 4> intervals = {10, 5, 2, 1};
enum Column : std::size_t { at_10_ms, at_5_ms, at_2_ms, at_1_ms };

/// A table: the share of operations that were done when they had to be, in per cent ("Recurrent Execution Check",
/// criterion 1).
struct PublishedTable {
  int number = 0;
  std::string_view protocol;           ///< "DDS", "OPC UA"
  std::string_view node;               ///< "update", "control", "diagnose"
  std::string_view operation;          ///< "publish", "subscribe"
  std::string_view system;             ///< "virtualised", "native" (Linux)
  std::array<double, 4> success = {};  ///< by column
  int tests = 0;                       ///< "TOTAL Number of Tests"
};

inline constexpr std::array<PublishedTable, 8> tables = {{
    {1, "DDS", "update", "publish", "virtualised", {100, 90, 74, 64}, 2790},
    {2, "DDS", "control", "publish", "native", {100, 93, 84.6, 77}, 2865},
    {3, "DDS", "control", "subscribe", "native", {100, 85, 65, 48.5}, 2805},
    {4, "DDS", "diagnose", "subscribe", "virtualised", {100, 85, 65, 47}, 3015},
    {5, "OPC UA", "update", "publish", "virtualised", {100, 95, 81.2, 56}, 2685},
    {6, "OPC UA", "control", "publish", "native", {100, 100, 87, 56}, 2970},
    {7, "OPC UA", "control", "subscribe", "native", {100, 100, 91, 85}, 3015},
    {8, "OPC UA", "diagnose", "subscribe", "virtualised", {100, 87.5, 77, 64}, 3015},
}};

/// A test looks at a window of this length, "a time interval still guaranteed to deliver by the operating system"
/// (section 4.1).
inline constexpr int window_ms = 10;
/// The intervals of Figures 5 to 9, in ms.
inline constexpr std::array<int, 5> signal_intervals = {100, 10, 5, 2, 1};

}  // namespace takt::papers::coexistence
