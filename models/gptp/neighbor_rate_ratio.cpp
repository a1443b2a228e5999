// SPDX-License-Identifier: Apache-2.0
#include "models/gptp/neighbor_rate_ratio.hpp"

#include <algorithm>

#include "sim/check.hpp"

namespace takt::models::gptp {

NeighborRateRatio::NeighborRateRatio(std::size_t window, bool compensate_drift)
    : window_(window), compensate_drift_(compensate_drift) {
  TAKT_CHECK(window >= 1 && window <= 1000, "a window of a few exchanges");
  ring_.resize(2 * window + 1);
}

void NeighborRateRatio::add(sim::PtpTime neighbor, sim::LocalTime local) {
  if (count_ > 0) {
    const sim::Duration theirs = neighbor - back(0).neighbor;
    const sim::Duration own = local - back(0).local;
    const bool plausible = theirs > sim::Duration() && own > sim::Duration() && theirs / 2 < own && own / 2 < theirs;
    if (!plausible) reset();
  }
  ring_[next_] = {neighbor, local};
  next_ = (next_ + 1) % ring_.size();
  count_ = std::min(count_ + 1, ring_.size());
}

ClockRate NeighborRateRatio::ratio_at(sim::LocalTime at) const {
  TAKT_CHECK(is_valid(), "at least two exchanges");
  const std::size_t span = compensate_drift_ ? std::min((count_ - 1) / 2, window_) : std::min(count_ - 1, window_);
  if (span == 0 || !compensate_drift_) return between(back(0), back(std::max<std::size_t>(span, 1)));
  const ClockRate recent = between(back(0), back(span));
  const ClockRate before = between(back(span), back(2 * span));
  const sim::Duration middles_apart = (back(0).local - back(2 * span).local) / 2;
  const sim::LocalTime middle = back(span).local + (back(0).local - back(span).local) / 2;
  const sim::int128 rise = sim::int128{(recent.minus_one() - before.minus_one()).multiple()};
  // A rise of 1 in 2^62 over at most years: the ratio of two durations is taken with 30 bits below the point.
  const sim::int128 ahead = (sim::int128{(at - middle).ps()} << 30) / std::max<std::int64_t>(middles_apart.ps(), 1);
  const sim::int128 change = (rise * std::clamp(ahead, sim::int128{0}, sim::int128{8} << 30)) >> 30;
  return ClockRate::one_plus(recent.minus_one() +
                             RateOffset::from_multiple(static_cast<std::int64_t>(std::clamp(
                                 change, -sim::int128{RateOffset::one} / 2, sim::int128{RateOffset::one} / 2))));
}

RateOffset NeighborRateRatio::drift_per_second() const {
  if (count_ < ring_.size()) return RateOffset();
  const sim::int128 rise = sim::int128{between(back(0), back(window_)).minus_one().multiple()} -
                           between(back(window_), back(2 * window_)).minus_one().multiple();
  const sim::Duration middles_apart = (back(0).local - back(2 * window_).local) / 2;
  constexpr sim::int128 second = 1'000'000'000'000;
  constexpr std::int64_t most = RateOffset::one / 1000;  // 1000 ppm/s, which no oscillator does
  return RateOffset::from_multiple(static_cast<std::int64_t>(std::clamp(
      divide_rounded(rise * second, sim::int128{middles_apart.ps()}), -sim::int128{most}, sim::int128{most})));
}

}  // namespace takt::models::gptp
