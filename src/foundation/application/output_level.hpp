// SPDX-License-Identifier: Apache-2.0
// The level of a digital output: its edges, pulses and periods.
#pragma once

#include <cstdint>
#include <optional>

#include "application/duration_figures.hpp"
#include "sim/time.hpp"

namespace takt::application {

/// What was seen of a digital output.
struct PulseFigures {
  DurationFigures
      latency;  ///< of each edge: from when the activation was due whose call has made it, on the clock of the host
  DurationFigures pulses;              ///< lengths of whole pulses, from rise to fall
  DurationFigures periods;             ///< from rise to rise
  std::uint64_t irregular_pulses = 0;  ///< of them, those that are more than 10 % off
  std::uint64_t irregular_periods = 0;

  /// One more. A pulse is nominally so long, a period twice that.
  void add_pulse(sim::Duration length, sim::Duration nominal) {
    pulses.add(length);
    irregular_pulses += is_off(length, nominal) ? 1 : 0;
  }
  void add_period(sim::Duration length, sim::Duration pulse) {
    periods.add(length);
    irregular_periods += is_off(length, pulse * 2) ? 1 : 0;
  }

 private:
  static bool is_off(sim::Duration length, sim::Duration nominal) {
    const sim::Duration off = length > nominal ? length - nominal : nominal - length;
    return off * 10 > nominal;
  }
};

/// It is low at the beginning. `Time` is TrueTime where it is observed from outside, LocalTime where a real node
/// observes itself.
template <class Time>
class OutputLevel {
 public:
  struct Edge {
    bool high = false;          ///< it ends a period; else a pulse
    std::optional<Time> began;  ///< when that began; nothing: it is the first rise, and ends nothing
  };

  /// It is set, at `now`. Nothing if it was there before.
  std::optional<Edge> set(bool high, Time now) {
    if (high == high_) return std::nullopt;
    high_ = high;
    const Edge edge{high, rise_};
    if (high) rise_ = now;
    return edge;
  }
  /// Tells the figures what has ended with the edge, if anything.
  static void count(const Edge& edge, Time now, sim::Duration pulse, PulseFigures& figures) {
    if (edge.began)
      edge.high ? figures.add_period(now - *edge.began, pulse) : figures.add_pulse(now - *edge.began, pulse);
  }
  bool is_high() const { return high_; }

 private:
  bool high_ = false;
  std::optional<Time> rise_;
};

}  // namespace takt::application
