// SPDX-License-Identifier: Apache-2.0
// Durations of happenings of one kind, in short.
#pragma once

#include <algorithm>
#include <cstdint>

#include "sim/time.hpp"

namespace takt::application {

/// Extrema, mean and deviation of durations.
class DurationFigures {
 public:
  void add(sim::Duration value) {
    least_ = count_ == 0 ? value : std::min(least_, value);
    greatest_ = count_ == 0 ? value : std::max(greatest_, value);
    ++count_;
    sum_ += value.ps();
    const double nanoseconds = static_cast<double>(value.ps()) / 1000.0;
    squares_ += nanoseconds * nanoseconds;
  }
  std::uint64_t count() const { return count_; }
  sim::Duration least() const { return least_; }
  sim::Duration greatest() const { return greatest_; }
  /// Precondition of these two: count() > 0.
  sim::Duration mean() const {
    return sim::Duration::from_ps(static_cast<std::int64_t>(sum_ / static_cast<sim::int128>(count_)));
  }
  /// In square nanoseconds.
  double variance_ns2() const {
    const double mean_ns = static_cast<double>(sum_) / 1000.0 / static_cast<double>(count_);
    return std::max(squares_ / static_cast<double>(count_) - mean_ns * mean_ns, 0.0);
  }

 private:
  std::uint64_t count_ = 0;
  sim::Duration least_;
  sim::Duration greatest_;
  sim::int128 sum_ = 0;
  double squares_ = 0;
};

}  // namespace takt::application
