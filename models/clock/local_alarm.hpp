// An alarm at a time of a clock that may change its rate or be stepped before it comes.
#pragma once

#include <algorithm>

#include "models/clock/local_clock.hpp"

namespace takt::models {

/// What an alarm waits for, and when that will be. A value: its owner keeps a timer of the simulation at due(), asks again after
/// each clock_changed(), and calls fired() when the timer comes.
///
/// Set at a local time it fires as soon as the clock shows that time or a later one: a step past it fires it at once, a step back
/// delays it. Set after a local interval it follows the clock's rate but no steps.
class LocalAlarm {
 public:
  void set_at(sim::LocalTime time) { set(Kind::at_time, time); }
  /// `interval` >= 0, measured by the clock from `now` on.
  void set_after(const LocalClock& clock, sim::TrueTime now, sim::Duration interval) {
    set(Kind::after_interval, clock.unstepped_at(now).plus_saturated(interval));
  }
  void cancel() { set(Kind::none, sim::LocalTime::never()); }
  bool is_set() const { return kind_ != Kind::none; }

  /// The true instant at which it fires if the clock goes on as it does now; not before `now`; never() if it is not set.
  sim::TrueTime due(const LocalClock& clock, sim::TrueTime now) const {
    if (kind_ == Kind::none) return sim::TrueTime::never();
    // Not true_at(): a time that a step back brings up again has been shown, but only in an earlier segment.
    if (kind_ == Kind::at_time) return clock.local_at(now) >= target_ ? now : std::max(clock.true_at(target_), now);
    return clock.unstepped_at(now) >= target_ ? now : std::max(clock.true_at_unstepped(target_), now);
  }

  /// True if the alarm fires at `now`; it is not set any more then.
  bool fired(const LocalClock& clock, sim::TrueTime now) {
    if (due(clock, now) != now) return false;
    cancel();
    return true;
  }

  bool operator==(const LocalAlarm&) const = default;

 private:
  enum class Kind : std::uint8_t { none, at_time, after_interval };
  void set(Kind kind, sim::LocalTime target) {
    kind_ = kind;
    target_ = target;
  }

  sim::LocalTime target_ = sim::LocalTime::never();  // of local_at(), or of unstepped_at()
  Kind kind_ = Kind::none;
};

}  // namespace takt::models
