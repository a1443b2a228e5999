// SPDX-License-Identifier: Apache-2.0
// What is counted by a node's clock, in true time.
#pragma once

#include <algorithm>
#include <cstdint>

#include "analysis/frame_arrivals.hpp"
#include "analysis/picoseconds.hpp"
#include "analysis/port_bound.hpp"

namespace takt::analysis {

/// A length of the clock's time, at least and at most.
inline Ps shortest(Ps local, const ClockQuality& clock) {
  return scaled_down(local, one_ppt, one_ppt + clock.fastest_ppt);
}
inline Ps longest(Ps local, const ClockQuality& clock) {
  return scaled_up(local, one_ppt, one_ppt + clock.slowest_ppt);
}

/// What a bucket that fills by that clock lets through.
inline ArrivalPattern by_clock(ArrivalPattern pattern, const ClockQuality& clock) {
  if (is_bounded(pattern.period)) pattern.period = std::max<Ps>(1, shortest(pattern.period, clock));
  pattern.jitter = sum(longest(pattern.jitter, clock), 2 * clock.error);
  return pattern;
}
/// The rate of such a bucket, at least, in bit/s.
inline std::int64_t slowest_rate(std::int64_t bits_per_second, const ClockQuality& clock) {
  return scaled_down(bits_per_second, one_ppt + clock.slowest_ppt, one_ppt);
}

}  // namespace takt::analysis
