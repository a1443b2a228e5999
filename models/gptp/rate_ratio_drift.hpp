// SPDX-License-Identifier: Apache-2.0
// How fast the ratio between the grandmaster's clock and one's own changes.
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

#include "models/clock/clock_rate.hpp"
#include "sim/check.hpp"
#include "sim/time.hpp"

namespace takt::models::gptp {

/// The slope of the rate ratios of the last Syncs: the mean of the newer half of the window less that of the older
/// half, over the time between their middles. A ratio that is handed on over many hops is old when it arrives: drifts d
/// make the time wrong by about d T^2 / 2 for T from the grandmaster to here. A relay that knows the slope brings the
/// ratio up to date. (IEEE 802.1ASdm has the Drift_Tracking TLV for this; here every relay finds the slope by itself,
/// and nothing is added on the wire.)
class RateRatioDrift {
 public:
  /// `window`: Syncs, even; 0: always says that there is no drift.
  explicit RateRatioDrift(std::size_t window) : ring_(window) { TAKT_CHECK(window % 2 == 0, "two halves"); }

  void add(sim::LocalTime at, ClockRate ratio) {
    if (ring_.empty()) return;
    ring_[next_] = {at, ratio.minus_one()};
    next_ = (next_ + 1) % ring_.size();
    count_ = std::min(count_ + 1, ring_.size());
  }
  void reset() { count_ = 0; }

  /// The change in a second; 0 until the window is full.
  RateOffset per_second() const {
    if (ring_.empty() || count_ < ring_.size()) return RateOffset();
    const std::size_t half = ring_.size() / 2;
    sim::int128 rise = 0, apart = 0;
    for (std::size_t i = 0; i < ring_.size(); ++i) {  // from the oldest on
      const Entry& entry = ring_[(next_ + i) % ring_.size()];
      rise += i < half ? -sim::int128{entry.ratio.multiple()} : sim::int128{entry.ratio.multiple()};
      apart += i < half ? -sim::int128{entry.at.ps()} : sim::int128{entry.at.ps()};
    }
    if (apart <= 0) return RateOffset();
    // Limited to 1000 ppm/s, which no oscillator does; a change of grandmaster in between would.
    constexpr std::int64_t most = RateOffset::one / 1000;
    constexpr sim::int128 second = 1'000'000'000'000;
    return RateOffset::from_multiple(static_cast<std::int64_t>(
        std::clamp(divide_rounded(rise * second, apart), -sim::int128{most}, sim::int128{most})));
  }

 private:
  struct Entry {
    sim::LocalTime at;
    RateOffset ratio;
  };
  std::vector<Entry> ring_;
  std::size_t next_ = 0;
  std::size_t count_ = 0;
};

}  // namespace takt::models::gptp
