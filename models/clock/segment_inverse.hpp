// SPDX-License-Identifier: Apache-2.0
// When a clock that runs at one rate shows a time, by one multiplication: a division of 128 bits takes ten times as
// long, and each frame of a talker asks.
//
// With the segment's local(start) = first * 2^62 + fraction in 2^-62 ps and its rate in 2^-62, the exact answer is
//   start + ceil(x / 2^62),   x = (d * 2^62 - fraction) * 2^62 / rate,   d = time - first.
// With inverse = floor(2^124 / rate) and passed = floor(fraction * inverse / 2^62), x lies between d * inverse - passed
// - 2 and that + d + 2, both excluded; where 2^124 / rate is whole, that + 2. Where no multiple of 2^62 lies between
// them, ceil(x / 2^62) is known; else nothing is said.
#pragma once

#include <cstdint>
#include <optional>

#include "models/clock/clock_rate.hpp"
#include "sim/time.hpp"

namespace takt::models {

class SegmentInverse {
 public:
  /// Says nothing.
  SegmentInverse() = default;

  /// Of the segment in which the clock shows `local` (in 2^-62 ps) at `start`, and goes on at `rate`.
  SegmentInverse(sim::TrueTime start, sim::int128 local, ClockRate rate) {
    const std::int64_t first = static_cast<std::int64_t>(local >> bits);
    if (rate.multiple() < one / 2 || start.ps() > max_start || first > max_start) return;
    const sim::uint128 numerator = sim::uint128{1} << (2 * bits);
    inverse_ = static_cast<std::uint64_t>(numerator / rate.multiple());
    is_inexact_ = numerator % rate.multiple() != 0 ? ~std::uint64_t{0} : 0;
    const auto fraction = static_cast<std::uint64_t>(local) & (one - 1);
    passed_ = static_cast<std::uint64_t>((sim::uint128{fraction} * inverse_) >> bits) + 2;
    first_ = static_cast<std::uint64_t>(first);
    start_ = start.ps() + 1;
    reach_ = max_distance;
  }

  /// The first instant of the segment at which the clock shows `time` or more, behind its start; nothing if that is not
  /// so or in doubt.
  std::optional<sim::TrueTime> at(sim::LocalTime time) const {
    const std::uint64_t distance = static_cast<std::uint64_t>(time.ps()) - first_;
    if (distance - 1 >= reach_) return std::nullopt;
    const sim::uint128 least = sim::uint128{distance} * inverse_ - passed_;
    if ((static_cast<std::uint64_t>(least) & (one - 1)) + (distance & is_inexact_) + 2 > one) [[unlikely]]
      return std::nullopt;
    return sim::TrueTime::from_ps(start_ + static_cast<std::int64_t>(least >> bits));
  }

 private:
  static constexpr int bits = RateOffset::fraction_bits;
  static constexpr std::uint64_t one = std::uint64_t{1} << bits;
  static constexpr std::uint64_t max_distance = std::uint64_t{1}
                                                << 56;  // 20 hours; further away more would be in doubt
  static constexpr std::int64_t max_start =
      std::int64_t{1} << 61;  // so that neither an answer nor what is asked for passes the last instant

  std::uint64_t first_ = 0;
  std::uint64_t reach_ = 0;  // of times behind first_; 0: nothing is said
  std::uint64_t inverse_ = 0;
  std::uint64_t passed_ = 0;      // and 2: what x may be less
  std::uint64_t is_inexact_ = 0;  // all bits, or none
  std::int64_t start_ = 0;        // and 1
};

}  // namespace takt::models
