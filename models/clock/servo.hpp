// SPDX-License-Identifier: Apache-2.0
// The servo: from measured offsets to the frequency (and the step) that brings a clock to its reference.
//
// The PI controller of linuxptp with its gain rule, kp = min(0.7 T^-0.3, 0.7/T) and ki = min(0.3 T^0.4, 0.3/T) for the
// sync interval T, its first frequency estimate over at least 0.016/ki seconds, its thresholds and states. On a
// frequency ramp D it keeps a steady offset of D T / ki (1 ppm/s at 125 ms: 957 ns).
//
// The drift-tracking variant adds an integrator for the drift itself, kd = kp ki T / 4, and so follows a ramp without
// offset. That gain keeps the loop stable at every interval (needed: kd < kp ki T) and adds little to its noise.
//
// Integers only: frequencies in 2^-62, gains in 2^-24 of that for each picosecond.
#pragma once

#include <cstdint>

#include "models/clock/clock_rate.hpp"
#include "sim/time.hpp"

namespace takt::models {

/// kp and ki as multiples of 2^-56: correction in ns/s for each ns of offset.
struct ServoGains {
  std::int64_t proportional = 0;
  std::int64_t integral = 0;

  static constexpr int lowest_log_interval = -7;
  static constexpr int highest_log_interval = 4;
  /// The rule above for T = 2^log_interval seconds; beyond the bounds as at them.
  static ServoGains of_interval(int log_interval);
  bool operator==(const ServoGains&) const = default;
};

enum class ServoKind : std::uint8_t { pi, drift_tracking };

struct ServoConfig {
  ServoKind kind = ServoKind::pi;
  int log_sync_interval = -3;
  sim::Duration first_step_threshold = sim::Duration::from_ps(20'000'000);  // 0: never step at first
  sim::Duration step_threshold = {};                                        // 0: never step again
  sim::FrequencyOffset highest_frequency{900'000'000'000};                  // what the clock can be trimmed by
  sim::Duration stable_threshold = {};                                      // 0: no state locked_stable
  int stable_count = 10;
};

enum class ServoState : std::uint8_t { unlocked, jump, locked, locked_stable };

/// What to do with the clock now.
struct ServoAction {
  ServoState state = ServoState::unlocked;
  RateOffset adjustment = {};  // for LocalClock::set_adjustment
  sim::Duration step;          // other than 0 in the state jump only
};

class Servo {
 public:
  explicit Servo(const ServoConfig& config);

  /// The clock is ahead of its reference by `offset` at the local time `at`.
  ServoAction sample(sim::Duration offset, sim::LocalTime at);
  /// The reference now sends at another interval: other gains, the same frequency.
  void set_log_sync_interval(int log_interval);
  /// Forgets offsets, keeps the frequency: a new reference, or sync lost for long. May the next sample step again?
  void restart(bool may_step);
  /// The adjustment when no sample has come for `since`: the last frequency; a drift-tracking servo lets it drift on.
  RateOffset holdover(sim::Duration since) const;

  ServoState state() const { return state_; }
  /// The frequency of the clock without adjustment, as the servo knows it.
  RateOffset frequency() const { return frequency_; }
  /// How much that changes in a sync interval (drift tracking only).
  RateOffset drift() const { return drift_; }

 private:
  RateOffset first_estimate(sim::Duration offset, sim::LocalTime at);
  RateOffset controlled(sim::Duration offset);
  bool steps(sim::Duration offset) const;
  ServoState locked_state(sim::Duration offset);
  RateOffset limited(sim::int128 y) const;

  ServoConfig config_;
  std::int64_t proportional_gain_ = 0;
  std::int64_t integral_gain_ = 0;
  std::int64_t drift_gain_ = 0;
  sim::Duration estimate_over_;  // the least time between the first two samples

  enum class Phase : std::uint8_t { first_sample, estimating, controlling };
  Phase phase_ = Phase::first_sample;
  ServoState state_ = ServoState::unlocked;
  bool first_update_ = true;
  int stable_left_ = 0;
  sim::Duration first_offset_;
  sim::LocalTime first_at_;
  RateOffset frequency_;  // linuxptp's drift
  RateOffset drift_;
  RateOffset last_;  // what was put out last, before its sign is turned
};

}  // namespace takt::models
