// SPDX-License-Identifier: Apache-2.0
// The arrival curve of a flow of equal frames: how many may come in any closed interval of a length. Staircases, in
// exact integers.
#pragma once

#include <algorithm>
#include <vector>

#include "analysis/picoseconds.hpp"

namespace takt::analysis {

/// `frames` in each period, at least `gap` apart, each late by up to `jitter`: in a closed interval of length t at most
/// k * frames + min(frames, rest / gap + 1), where t + jitter = k * period + rest.
/// A token bucket of frames of b bits is one too: period b / rate, jitter burst / rate - period.
struct ArrivalPattern {
  Ps period = unbounded_ps;  ///< > 0; unbounded: it happens once
  std::int64_t frames = 1;
  Ps gap = 0;     ///< (frames - 1) * gap < period
  Ps jitter = 0;  ///< unbounded: any number at any time

  bool is_limited() const { return is_bounded(jitter); }
  std::int64_t count(Ps length) const {
    const Ps t = length + jitter;
    const std::int64_t k = t / period;
    const Ps rest = t % period;
    return k * frames + (gap == 0 ? frames : std::min(frames, rest / gap + 1));
  }
  /// The least length greater than this one with a greater count.
  Ps next_jump(Ps length) const {
    const Ps t = length + jitter;
    const Ps start = t - t % period;
    if (gap > 0)
      if (const std::int64_t seen = t % period / gap + 1; seen < frames) return start + seen * gap - jitter;
    return is_bounded(period) ? sum(start, period) - jitter : unbounded_ps;
  }
  /// Frames in a second of true time in the long run, in frames per picosecond.
  double rate() const { return is_bounded(period) ? static_cast<double>(frames) / static_cast<double>(period) : 0.0; }
  /// count(t) <= burst() + rate() * t.
  double burst() const {
    return static_cast<double>(frames) + (jitter == 0 ? 0.0 : rate() * static_cast<double>(jitter));
  }
};

/// What several patterns that all hold allow: the least of their counts.
class FrameArrivals {
 public:
  FrameArrivals() = default;
  explicit FrameArrivals(ArrivalPattern pattern) { add(pattern); }
  void add(const ArrivalPattern& pattern) {
    if (pattern.is_limited()) patterns_.push_back(pattern);
  }
  /// Frames come late by up to so much more.
  FrameArrivals delayed(Ps jitter) const {
    FrameArrivals later;
    for (ArrivalPattern pattern : patterns_) {
      pattern.jitter = sum(pattern.jitter, jitter);
      later.add(pattern);
    }
    return later;
  }

  bool is_limited() const { return !patterns_.empty(); }
  const std::vector<ArrivalPattern>& patterns() const { return patterns_; }
  /// Precondition: is_limited().
  std::int64_t count(Ps length) const {
    std::int64_t least = patterns_.front().count(length);
    for (const ArrivalPattern& pattern : patterns_) least = std::min(least, pattern.count(length));
    return least;
  }
  /// Not after the next length with a greater count.
  Ps next_jump(Ps length) const {
    Ps next = unbounded_ps;
    for (const ArrivalPattern& pattern : patterns_) next = std::min(next, pattern.next_jump(length));
    return next;
  }
  /// The pattern with the least long-run rate stands for all where a line is asked for.
  const ArrivalPattern& calmest() const {
    return *std::min_element(patterns_.begin(), patterns_.end(), [](const ArrivalPattern& a, const ArrivalPattern& b) {
      return a.rate() != b.rate() ? a.rate() < b.rate() : a.burst() < b.burst();
    });
  }

 private:
  std::vector<ArrivalPattern> patterns_;  // empty: any number at any time
};

/// Whether a flow keeps to a token bucket: `bits` a frame, burst in bits, rate in bit/s.
bool conforms(const FrameArrivals& arrivals, std::int64_t bits, std::int64_t burst_bits, std::int64_t bits_per_second);
/// How long a token bucket that serves this flow alone keeps a frame back at most. Unbounded if more comes than its
/// rate.
Ps longest_hold(const FrameArrivals& arrivals, std::int64_t bits, std::int64_t burst_bits,
                std::int64_t bits_per_second);
/// The pattern that a token bucket leaves of frames of that many bits; unlimited if the bucket holds less than one.
ArrivalPattern pattern_of_token_bucket(std::int64_t bits, std::int64_t burst_bits, std::int64_t bits_per_second);

}  // namespace takt::analysis
