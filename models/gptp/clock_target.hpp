// SPDX-License-Identifier: Apache-2.0
// The clock that gPTP disciplines: from SyncSamples to adjustments of a LocalClock, with holdover in between.
#pragma once

#include "models/clock/servo.hpp"
#include "models/gptp/output.hpp"

namespace takt::models::gptp {

/// The first of ClockState (station.hpp), in its order.
enum class TargetState : std::uint8_t { free_running, acquiring, locked, holdover };

struct ClockTargetConfig {
  ServoConfig servo = {};
  bool step_after_grandmaster_change = true;  // the first estimate under a new grandmaster may step again
};

/// A value beside the node's disciplined clock. The host asks what the disciplined clock shows at the instant of the
/// sample (true_at() of the free-running clock, local_at() of the disciplined one) and does with it what the action
/// says.
class ClockTarget {
 public:
  explicit ClockTarget(const ClockTargetConfig& config) : config_(config), servo_(config.servo) {}

  /// `shown` by the disciplined clock at sample.at.
  ServoAction sample(const SyncSample& sample, sim::LocalTime shown) {
    if (state_ != TargetState::free_running && sample.grandmaster != grandmaster_)
      servo_.restart(config_.step_after_grandmaster_change);
    grandmaster_ = sample.grandmaster;
    if (sample.log_sync_interval != log_interval_)
      servo_.set_log_sync_interval(log_interval_ = sample.log_sync_interval);
    offset_ = sim::Duration::from_ps(shown.ps() - sample.grandmaster_time.ps());
    at_ = sample.at;
    const ServoAction action = servo_.sample(offset_, shown);
    const bool locked = action.state == ServoState::locked || action.state == ServoState::locked_stable;
    state_ = locked ? TargetState::locked : TargetState::acquiring;
    return action;
  }

  /// No Sync any more. A free-running clock stays one.
  void sync_lost() {
    if (state_ != TargetState::free_running) state_ = TargetState::holdover;
  }
  /// The adjustment at the instant `now` (of the free-running clock) of a holdover. It stays the same unless the servo
  /// tracks the drift; then a host that asks once in a while follows it.
  RateOffset holdover_adjustment(sim::LocalTime now) const { return servo_.holdover(now - at_); }

  TargetState state() const { return state_; }
  /// Of the last sample.
  sim::Duration offset() const { return offset_; }
  const Servo& servo() const { return servo_; }

 private:
  ClockTargetConfig config_;
  Servo servo_;
  TargetState state_ = TargetState::free_running;
  ClockIdentity grandmaster_;
  int log_interval_ = config_.servo.log_sync_interval;
  sim::Duration offset_;
  sim::LocalTime at_;
};

}  // namespace takt::models::gptp
