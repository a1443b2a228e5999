// SPDX-License-Identifier: Apache-2.0
// Times as they stand in PTP messages, and what they are in picoseconds.
#pragma once

#include <compare>
#include <cstdint>
#include <limits>

#include "models/clock/clock_rate.hpp"
#include "sim/time.hpp"

namespace takt::models::gptp {

/// A Timestamp: seconds (48 bits) and nanoseconds (below 10^9). The simulation counts from its own start and does
/// without an epoch, so its seconds are small; what stands in a message may be anything.
struct Timestamp {
  std::uint64_t seconds = 0;
  std::uint32_t nanoseconds = 0;

  /// The whole nanoseconds of `time`; times before zero are given as zero.
  static constexpr Timestamp floor_of(sim::PtpTime time) {
    const std::int64_t ps = time.ps() < 0 ? 0 : time.ps();
    constexpr std::int64_t second = 1'000'000'000'000;
    return {static_cast<std::uint64_t>(ps / second), static_cast<std::uint32_t>(ps % second / 1000)};
  }
  /// True if it lies within the simulation's range of time.
  constexpr bool in_range() const { return seconds < 9'000'000 && nanoseconds < 1'000'000'000; }
  /// Precondition: in_range().
  constexpr sim::PtpTime time() const {
    return sim::PtpTime::from_ps(static_cast<std::int64_t>(seconds) * 1'000'000'000'000 +
                                 std::int64_t{nanoseconds} * 1000);
  }
  auto operator<=>(const Timestamp&) const = default;
};

/// A correctionField: multiples of 2^-16 ns. Finer than a picosecond (65.536 of it are one), so of() and duration() are
/// exact one way round.
struct Correction {
  std::int64_t scaled_ns = 0;

  static constexpr Correction of(sim::Duration d) {
    return {static_cast<std::int64_t>(divide_rounded(sim::int128{d.ps()} * 8192, 125))};
  }
  constexpr sim::Duration duration() const {
    return sim::Duration::from_ps(static_cast<std::int64_t>(divide_rounded(sim::int128{scaled_ns} * 125, 8192)));
  }
  /// Half the range: about 39 hours. A sum of a few of these cannot overflow a Duration or a Correction.
  constexpr bool in_range() const { return scaled_ns > -(std::int64_t{1} << 62) && scaled_ns < std::int64_t{1} << 62; }
  friend constexpr Correction operator+(Correction a, Correction b) { return {a.scaled_ns + b.scaled_ns}; }
  auto operator<=>(const Correction&) const = default;
};

/// 2^log seconds, for -16 <= log <= 16 (others as at the bounds).
constexpr sim::Duration interval_of(int log) {
  const int limited = log < -16 ? -16 : log > 16 ? 16 : log;
  constexpr std::int64_t second = 1'000'000'000'000;
  return sim::Duration::from_ps(limited >= 0 ? second << limited : second >> -limited);
}

}  // namespace takt::models::gptp
