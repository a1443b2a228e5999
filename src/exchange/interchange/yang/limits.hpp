// SPDX-License-Identifier: Apache-2.0
// What devices announce that they can: lengths of gate lists, longest cycles and intervals, granularity.
#pragma once

#include <map>
#include <optional>
#include <string>

#include "interchange/yang/data.hpp"

namespace takt::interchange::yang {

/// Of a port; what is not announced is absent.
struct PortLimits {
  std::optional<std::uint64_t> entries;
  std::optional<sim::Duration> longest_cycle;
  std::optional<std::uint64_t> longest_interval_ns;
  std::optional<std::uint64_t> tick_tenths_of_ns;
  /// By speed in Mb/s: shortest cycle and interval.
  struct Shortest {
    std::optional<sim::Duration> cycle;
    std::optional<std::uint64_t> interval_ns;
  };
  std::map<std::uint64_t, Shortest> shortest;
  bool says_something() const {
    return entries || longest_cycle || longest_interval_ns || tick_tenths_of_ns || !shortest.empty();
  }
};

/// numerator and denominator of a second; null if that is no whole number of ps, or nothing.
std::optional<sim::Duration> seconds_of(const Data& rational);

/// The limits of a table of gates, in either dialect.
PortLimits limits_of(const Data& gates);

}  // namespace takt::interchange::yang
