// SPDX-License-Identifier: Apache-2.0
// What a clock runs on: the frequency of an oscillator as a function of true time.
//
// y(t) = offset + drift * t + temperature(t) + table(t) + walk(t), relative to nominal. The frequency is constant for
// an update interval at a time. For the smooth terms it is the value in the middle of the interval, so that a linear
// drift has the exact phase at every boundary of an interval and within it at most drift * interval^2 / 8 (1 ppm/s and
// 10 ms: 12.5 ps).
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

#include "models/clock/clock_rate.hpp"
#include "sim/random.hpp"
#include "sim/time.hpp"
#include "sim/units.hpp"

namespace takt::models {

/// Temperature going up and down: amplitude * sin(2 pi (t / period + phase)).
struct SinusoidalFrequency {
  sim::FrequencyOffset amplitude = {};
  sim::Duration period = sim::Duration::from_ps(1'000'000'000'000);  // > 0
  std::uint64_t phase = 0;                                           // in turns of 2^-64
};

/// At each update the walk takes a step, uniform in [-step, step], and stays within [-bound, bound].
struct FrequencyWalk {
  sim::FrequencyOffset step = {};
  sim::FrequencyOffset bound = {};
};

/// A frequency that was measured: linear between the points, constant before the first and after the last.
struct FrequencyPoint {
  sim::TrueTime time = {};
  sim::FrequencyOffset frequency = {};
};

struct OscillatorConfig {
  sim::FrequencyOffset offset = {};
  std::int64_t drift_ppt_per_second = 0;  // 1 ppm/s = 1'000'000
  std::optional<SinusoidalFrequency> temperature = {};
  std::optional<FrequencyWalk> walk = {};
  std::vector<FrequencyPoint> table = {};       // strictly ascending times
  sim::FrequencyOffset bound{500'000'000'000};  // |y| is limited to this
  sim::Duration update_interval = sim::Duration::from_ps(10'000'000'000);

  /// True if the frequency never changes: no event is ever needed.
  bool is_constant() const { return drift_ppt_per_second == 0 && !temperature && !walk && table.size() < 2; }
};

/// What a scenario says of many nodes at once: each value lies between two bounds, both included.
struct OscillatorRange {
  sim::FrequencyOffset lowest_offset = {};
  sim::FrequencyOffset highest_offset = {};
  std::int64_t lowest_drift_ppt_per_second = 0;
  std::int64_t highest_drift_ppt_per_second = 0;
};

/// The offset and the drift of the node at `path`: uniform in the range, a function of (seed, path). Two draws, always.
void draw_oscillator(const OscillatorRange& range, std::uint64_t seed, std::string_view path, OscillatorConfig& config);

/// The rate as it goes on, update by update. A value: a copy goes on in the same way.
class Oscillator {
 public:
  /// `path` names the node in the random streams; only a walk draws from them, one number an update.
  explicit Oscillator(OscillatorConfig config, std::uint64_t seed = 0, std::string_view path = {});

  /// The rate from the last update until next_change().
  ClockRate rate() const { return rate_; }
  /// When advance() is due; never() if the frequency does not change any more.
  sim::TrueTime next_change() const { return next_change_; }
  /// Goes on to the interval that begins at next_change(). Precondition: there is one.
  void advance();
  /// The frequency changes for another reason than its model (a fault): from `now` on the offset is another one.
  void set_offset(sim::TrueTime now, sim::FrequencyOffset offset);

 private:
  sim::TrueTime next_after(sim::TrueTime time) const;
  ClockRate rate_in_interval() const;
  std::int64_t smooth_ppt(sim::TrueTime time) const;
  RateOffset temperature_at(sim::TrueTime time) const;
  std::int64_t table_ppt(sim::TrueTime time) const;

  OscillatorConfig config_;
  sim::RandomStream chance_;
  std::int64_t walk_ppt_ = 0;
  sim::TrueTime interval_start_;
  sim::TrueTime next_change_;
  ClockRate rate_;
};

}  // namespace takt::models
