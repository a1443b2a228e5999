// SPDX-License-Identifier: Apache-2.0
// A ratio of two clocks that is not constant.
#pragma once

#include "models/clock/clock_rate.hpp"
#include "sim/time.hpp"

namespace takt::models::gptp {

/// A rate that changes: `rate` at one instant, and by `drift` in each second after it.
struct DriftingRate {
  ClockRate rate = {};
  RateOffset drift = {};

  ClockRate after(sim::Duration d) const {
    if (drift == RateOffset()) return rate;
    return ClockRate::one_plus(rate.minus_one() + RateOffset::from_multiple(static_cast<std::int64_t>(divide_rounded(
                                                      sim::int128{drift.multiple()} * d.ps(), 1'000'000'000'000))));
  }
  /// What passes on the one clock while `d` passes on the other: the mean rate is that in the middle.
  sim::Duration times(sim::Duration d) const { return after(d / 2).times(d); }
};

}  // namespace takt::models::gptp
