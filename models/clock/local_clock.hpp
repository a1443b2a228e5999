// SPDX-License-Identifier: Apache-2.0
// The clock of a node: what maps true time to the node's own time and back.
//
// The map is piecewise linear: a segment begins at each change of rate and at each step. Within a segment
//   local_at(t) = floor(local(start) + rate * (t - start))     exact, in 128 bits, with 62 bits below the picosecond
//   true_at(l)  = the first instant t of the segment at which local_at(t) >= l
// so that, without a step in between:
//   local_at(true_at(l)) >= l and local_at(true_at(l) - 1 ps) < l      equal to l where the rate is at most 1
//   true_at(local_at(t)) <= t and local_at(true_at(local_at(t))) == local_at(t)
// A change of rate carries the fraction of a picosecond over; nothing is lost however often a servo moves.
//
// What lies before the present segment is answered by the one before it (no further back). After a step forwards the
// local times that were passed over map to the instant of the step; after a step backwards those that come twice map to
// the present segment, the second time. never() maps to never(), as does what lies beyond the last instant.
#pragma once

#include <algorithm>
#include <optional>
#include <vector>

#include "models/clock/clock_rate.hpp"
#include "models/clock/equal_steps.hpp"
#include "models/clock/segment_inverse.hpp"
#include "sim/time.hpp"

namespace takt::models {

class LocalClock;

/// Who must know when the map of a clock changes: what has asked true_at() of a time to come has to ask again.
class ClockListener {
 public:
  virtual ~ClockListener() = default;
  /// The clock is about to change and still answers with its former map. For listeners that evaluate past instants
  /// late: after a step backwards, local times that occur twice mean the second occurrence.
  virtual void clock_will_change(const LocalClock& clock, sim::TrueTime now) {
    static_cast<void>(clock), static_cast<void>(now);
  }
  /// The clock has changed its rate or was stepped, at `now`; it answers with the new map already.
  virtual void clock_changed(const LocalClock& clock, sim::TrueTime now) = 0;
};

/// A clock that shows true time until it is adjusted. All that a node does at a local time is converted here.
/// Its rate is the product of the oscillator's (hardware_rate) and of what a servo makes of it (1 + adjustment).
/// Changes come in the order of true time. Listeners are called in the order in which they were added.
class LocalClock {
 public:
  LocalClock() = default;
  LocalClock(const LocalClock&) = delete;  // listeners and users keep its address
  LocalClock& operator=(const LocalClock&) = delete;

  sim::LocalTime local_at(sim::TrueTime time) const {
    if (ideal_) [[likely]]
      return sim::LocalTime::from_ps(time.ps());
    return local_in_segments(time);
  }
  sim::TrueTime true_at(sim::LocalTime time) const {
    if (ideal_) [[likely]]
      return sim::TrueTime::from_ps(time.ps());
    if (const std::optional<sim::TrueTime> in_present = inverse_.at(time)) [[likely]]
      return *in_present;
    return true_in_segments(time);
  }

  /// true_at(time + step), true_at(time + 2 step) ... until the clock changes; not set where that does not follow from
  /// true_at(time): before the present segment, and after the last instant. Precondition: step >= 0.
  EqualSteps steps_from(sim::LocalTime time, sim::Duration step) const;

  /// When to ask again for what becomes true at `time`: after `now` in any case, also where the clock shows `time`
  /// already.
  sim::TrueTime true_after(sim::LocalTime time, sim::TrueTime now) const {
    return std::max(true_at(time), now + sim::Duration::from_ps(1));
  }

  /// The time of this clock as if it had never been stepped: follows the rate, never goes back, never jumps. Local
  /// intervals are measured on it. Equal to local_at() until the first step.
  sim::LocalTime unstepped_at(sim::TrueTime time) const {
    if (ideal_) [[likely]]
      return sim::LocalTime::from_ps(time.ps());
    return unstepped_in_segments(time);
  }
  /// The first instant at which unstepped_at() is at least `time`.
  sim::TrueTime true_at_unstepped(sim::LocalTime time) const;

  bool is_ideal() const { return ideal_; }
  ClockRate rate() const { return present_.rate; }
  ClockRate hardware_rate() const { return hardware_rate_; }
  RateOffset adjustment() const { return adjustment_; }
  /// The sum of all steps.
  sim::Duration stepped() const { return present_.stepped; }

  /// The oscillator changes its frequency.
  void set_hardware_rate(sim::TrueTime now, ClockRate rate);
  /// A servo trims the frequency: positive makes the clock faster.
  void set_adjustment(sim::TrueTime now, RateOffset adjustment);
  /// Jumps by `by`, either way.
  void step(sim::TrueTime now, sim::Duration by);
  /// A step and a trim at once, as a servo makes them: the listeners hear of it once.
  void step_and_adjust(sim::TrueTime now, sim::Duration by, RateOffset adjustment);

  void add_listener(ClockListener& listener) { listeners_.push_back(&listener); }
  void remove_listener(ClockListener& listener) { std::erase(listeners_, &listener); }

 private:
  struct Segment {
    sim::TrueTime start;
    sim::int128 local = 0;  // at the start, in 2^-62 ps
    ClockRate rate;
    sim::Duration stepped;  // how much of it is due to steps

    sim::LocalTime local_at(sim::TrueTime time) const;
    sim::TrueTime true_at(sim::LocalTime time) const;  // may lie before the start
  };

  sim::LocalTime local_in_segments(sim::TrueTime time) const;
  sim::TrueTime true_in_segments(sim::LocalTime time) const;
  sim::LocalTime unstepped_in_segments(sim::TrueTime time) const;
  void begin_segment(sim::TrueTime now, sim::Duration step);

  bool ideal_ = true;
  SegmentInverse inverse_;  // of the present segment
  Segment present_;
  Segment previous_;
  ClockRate hardware_rate_;
  RateOffset adjustment_;
  std::vector<ClockListener*> listeners_;
};

}  // namespace takt::models
