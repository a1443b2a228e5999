// A digital output as an oscilloscope sees it: edges in true time, pulses and periods. A ghost.
#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>
#include <vector>

#include "sim/time.hpp"

namespace takt::scenario {

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
  sim::Duration mean() const { return sim::Duration::from_ps(static_cast<std::int64_t>(sum_ / static_cast<sim::int128>(count_))); }
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

class DigitalOutput {
 public:
  struct Edge {
    sim::TrueTime at;
    bool high = false;
  };

  /// A pulse is nominally so long, a period twice that.
  explicit DigitalOutput(sim::Duration pulse) : pulse_(pulse) {}

  /// It is low at the beginning. True if the level has changed.
  bool set(bool high, sim::TrueTime now);

  bool is_high() const { return high_; }
  sim::Duration pulse() const { return pulse_; }
  /// Lengths of whole pulses, from rise to fall.
  const DurationFigures& pulses() const { return pulses_; }
  /// From rise to rise.
  const DurationFigures& periods() const { return periods_; }
  /// Of them, those that are more than 10 % off.
  std::uint64_t irregular_pulses() const { return irregular_pulses_; }
  std::uint64_t irregular_periods() const { return irregular_periods_; }
  /// The first ones.
  const std::vector<Edge>& edges() const { return edges_; }
  static constexpr std::size_t most_edges = 10'000;

 private:
  static bool is_off(sim::Duration length, sim::Duration nominal);

  sim::Duration pulse_;
  bool high_ = false;
  std::optional<sim::TrueTime> rise_;
  DurationFigures pulses_;
  DurationFigures periods_;
  std::uint64_t irregular_pulses_ = 0;
  std::uint64_t irregular_periods_ = 0;
  std::vector<Edge> edges_;
};

}  // namespace takt::scenario
