// SPDX-License-Identifier: Apache-2.0
// neighborRateRatio: how fast the neighbour's clock runs against one's own.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "models/clock/clock_rate.hpp"
#include "sim/time.hpp"

namespace takt::models::gptp {

/// r = (t3[k] - t3[k-N]) / (t4[k] - t4[k-N]) over a window of N exchanges; over fewer at the beginning.
/// Timestamp noise e makes it wrong by 2e/(N interval); a frequency that drifts by d makes it late by d N interval / 2.
/// With drift compensation it takes the window before into account as well and goes on along the line through the
/// middles of both: no lag behind a steady drift, for about four times the noise.
class NeighborRateRatio {
 public:
  /// Precondition: 1 <= window <= 1000.
  explicit NeighborRateRatio(std::size_t window, bool compensate_drift = false);

  /// An exchange: t3 as the neighbour wrote it (its own clock), t4 by one's own clock. Both must go forwards, and
  /// neither at more than twice the rate of the other: otherwise what was known is forgotten first.
  void add(sim::PtpTime neighbor, sim::LocalTime local);
  void reset() { count_ = 0; }

  bool is_valid() const { return count_ >= 2; }
  /// The ratio at the local instant `at`, not before the last exchange. Precondition: is_valid().
  ClockRate ratio_at(sim::LocalTime at) const;
  /// How much the ratio changes in a second, by the window and the one before; 0 while these are not full.
  RateOffset drift_per_second() const;

 private:
  struct Exchange {
    sim::PtpTime neighbor;
    sim::LocalTime local;
  };
  const Exchange& back(std::size_t ago) const { return ring_[(next_ + ring_.size() - 1 - ago) % ring_.size()]; }
  ClockRate between(const Exchange& later, const Exchange& earlier) const {
    return ClockRate::ratio(later.neighbor - earlier.neighbor, later.local - earlier.local);
  }

  std::size_t window_;
  bool compensate_drift_;
  std::vector<Exchange> ring_;
  std::size_t next_ = 0;
  std::size_t count_ = 0;
};

}  // namespace takt::models::gptp
