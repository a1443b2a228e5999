// A digital output as an oscilloscope sees it: edges in true time, pulses and periods. Nobody asks it.
#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "scenario/figures/accounts.hpp"
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

  /// Of pulses and periods that began with a rise at an instant or later.
  struct Figures {
    DurationFigures pulses;               ///< lengths of whole pulses, from rise to fall
    DurationFigures periods;              ///< from rise to rise
    std::uint64_t irregular_pulses = 0;   ///< of them, those that are more than 10 % off
    std::uint64_t irregular_periods = 0;
  };

  /// A pulse is nominally so long, a period twice that. Figures are kept from each of the instants on.
  DigitalOutput(sim::Duration pulse, std::span<const sim::Duration> instants) : pulse_(pulse), figures_(instants) {}

  /// It is low at the beginning. True if the level has changed.
  bool set(bool high, sim::TrueTime now);

  bool is_high() const { return high_; }
  sim::Duration pulse() const { return pulse_; }
  const Figures& figures(sim::Duration from) const { return figures_.from(from); }
  /// The first ones.
  const std::vector<Edge>& edges() const { return edges_; }
  static constexpr std::size_t most_edges = 10'000;

 private:
  static bool is_off(sim::Duration length, sim::Duration nominal);

  sim::Duration pulse_;
  bool high_ = false;
  std::optional<sim::TrueTime> rise_;
  Accounts<Figures> figures_;
  std::vector<Edge> edges_;
};

}  // namespace takt::scenario
