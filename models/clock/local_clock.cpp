// SPDX-License-Identifier: Apache-2.0
#include "models/clock/local_clock.hpp"

#include <algorithm>

#include "sim/check.hpp"

namespace takt::models {
namespace {

constexpr int fraction_bits = RateOffset::fraction_bits;
constexpr sim::int128 largest = std::numeric_limits<std::int64_t>::max();
constexpr sim::int128 smallest = std::numeric_limits<std::int64_t>::min();

/// The instant at `ps`; what lies beyond all instants is the last, or the first.
template <class Time>
Time limited(sim::int128 ps) {
  return Time::from_ps(static_cast<std::int64_t>(std::clamp(ps, smallest, largest)));
}

/// a / b rounded up. Precondition: b > 0.
sim::int128 divide_up(sim::int128 a, sim::int128 b) {
  const sim::int128 quotient = a / b;
  return quotient * b < a ? quotient + 1 : quotient;
}

}  // namespace

// |rate| <= 2^63 and |time - start| < 2^64 would pass 2^127, but true times are not negative: the difference is below
// 2^63.
sim::LocalTime LocalClock::Segment::local_at(sim::TrueTime time) const {
  if (time == sim::TrueTime::never()) return sim::LocalTime::never();
  const sim::int128 elapsed = sim::int128{time.ps()} - start.ps();
  return limited<sim::LocalTime>((local + elapsed * static_cast<sim::int128>(rate.multiple())) >> fraction_bits);
}

sim::TrueTime LocalClock::Segment::true_at(sim::LocalTime time) const {
  if (time == sim::LocalTime::never()) return sim::TrueTime::never();
  const sim::int128 missing = (sim::int128{time.ps()} << fraction_bits) - local;
  return limited<sim::TrueTime>(start.ps() + divide_up(missing, static_cast<sim::int128>(rate.multiple())));
}

sim::LocalTime LocalClock::local_in_segments(sim::TrueTime time) const {
  return time >= present_.start ? present_.local_at(time) : previous_.local_at(time);
}

sim::TrueTime LocalClock::true_in_segments(sim::LocalTime time) const {
  const sim::TrueTime in_present = present_.true_at(time);
  if (in_present > present_.start) return in_present;
  // The time shown at the beginning of the segment, or one before it.
  if (time == present_.local_at(present_.start) && present_.stepped != previous_.stepped) return present_.start;
  return std::min(previous_.true_at(time), present_.start);
}

EqualSteps LocalClock::steps_from(sim::LocalTime time, sim::Duration step) const {
  TAKT_CHECK(step >= sim::Duration(), "times that come one after the other");
  EqualSteps steps;
  const sim::TrueTime first = present_.true_at(time);
  if ((first <= present_.start && !ideal_) || first < sim::TrueTime() || first == sim::TrueTime::never()) return steps;
  const sim::int128 rate = present_.rate.multiple();
  const sim::int128 distance = sim::int128{step.ps()} << fraction_bits;
  steps.time_ = static_cast<std::uint64_t>(first.ps());
  steps.whole_ = static_cast<std::uint64_t>(std::min(distance / rate, largest));
  steps.part_ = static_cast<std::uint64_t>(distance % rate);
  steps.early_ = static_cast<std::uint64_t>((sim::int128{first.ps()} - present_.start.ps()) * rate -
                                            ((sim::int128{time.ps()} << fraction_bits) - present_.local));
  steps.rate_ = present_.rate.multiple();
  return steps;
}

sim::LocalTime LocalClock::unstepped_in_segments(sim::TrueTime time) const {
  const sim::LocalTime shown = local_at(time);
  if (shown == sim::LocalTime::never()) return shown;
  return shown - (time >= present_.start ? present_ : previous_).stepped;
}

sim::TrueTime LocalClock::true_at_unstepped(sim::LocalTime time) const {
  if (time == sim::LocalTime::never()) return sim::TrueTime::never();
  const sim::TrueTime in_present =
      present_.true_at(limited<sim::LocalTime>(sim::int128{time.ps()} + present_.stepped.ps()));
  if (in_present > present_.start) return in_present;
  return std::min(previous_.true_at(limited<sim::LocalTime>(sim::int128{time.ps()} + previous_.stepped.ps())),
                  present_.start);
}

void LocalClock::set_hardware_rate(sim::TrueTime now, ClockRate rate) {
  hardware_rate_ = rate;
  begin_segment(now, sim::Duration());
}

void LocalClock::set_adjustment(sim::TrueTime now, RateOffset adjustment) {
  adjustment_ = adjustment;
  begin_segment(now, sim::Duration());
}

void LocalClock::step(sim::TrueTime now, sim::Duration by) { begin_segment(now, by); }

void LocalClock::step_and_adjust(sim::TrueTime now, sim::Duration by, RateOffset adjustment) {
  adjustment_ = adjustment;
  begin_segment(now, by);
}

void LocalClock::begin_segment(sim::TrueTime now, sim::Duration step) {
  TAKT_CHECK(now >= present_.start && now != sim::TrueTime::never(), "a clock changes in the order of true time");
  const ClockRate rate = hardware_rate_ * ClockRate::one_plus(adjustment_);
  if (rate == present_.rate && step == sim::Duration()) return;
  for (ClockListener* const listener : listeners_) listener->clock_will_change(*this, now);
  ideal_ = false;
  Segment next = present_;
  next.start = now;
  next.local += (sim::int128{now.ps()} - present_.start.ps()) * static_cast<sim::int128>(present_.rate.multiple());
  next.local += sim::int128{step.ps()} << fraction_bits;
  next.rate = rate;
  next.stepped += step;
  TAKT_CHECK(next.local >> fraction_bits < largest && next.local >> fraction_bits > smallest,
             "local time within its range");
  if (now != present_.start) previous_ = present_;  // a second change at one instant belongs to the first
  present_ = next;
  inverse_ = SegmentInverse(now, next.local, rate);
  for (ClockListener* const listener : listeners_) listener->clock_changed(*this, now);
}

}  // namespace takt::models
