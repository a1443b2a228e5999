// SPDX-License-Identifier: Apache-2.0
#include "models/clock/local_clock.hpp"

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <vector>

namespace takt::models::local_clock_test {
namespace {

using namespace sim::literals;
using sim::Duration;
using sim::LocalTime;
using sim::TrueTime;

TrueTime true_time(Duration d) { return TrueTime() + d; }
LocalTime local(Duration d) { return LocalTime() + d; }
ClockRate ppm(std::int64_t n) { return ClockRate::one_plus(RateOffset::from({n * 1'000'000})); }

TEST(LocalClock, BeginsIdeal) {
  const LocalClock clock;
  EXPECT_TRUE(clock.is_ideal());
  for (const Duration d : {0_ps, 1_ps, 17_s}) {
    EXPECT_EQ(clock.local_at(true_time(d)), local(d));
    EXPECT_EQ(clock.true_at(local(d)), true_time(d));
  }
  EXPECT_EQ(clock.true_at(LocalTime::never()), TrueTime::never());
}

TEST(LocalClock, RunsAtItsRate) {
  LocalClock clock;
  clock.set_hardware_rate(TrueTime(), ppm(100));
  EXPECT_EQ(clock.local_at(true_time(1_s)), local(1_s + 100_us));
  EXPECT_EQ(clock.true_at(local(1_s + 100_us)), true_time(1_s));
  EXPECT_EQ(clock.local_at(TrueTime::never()), LocalTime::never());
  EXPECT_EQ(clock.true_at(LocalTime::never()), TrueTime::never());
  EXPECT_FALSE(clock.is_ideal());
}

TEST(LocalClock, TheTrimMultipliesTheOscillator) {
  LocalClock clock;
  clock.set_hardware_rate(TrueTime(), ppm(100));
  clock.set_adjustment(true_time(1_s), RateOffset::from({-100'000'000}));
  // 1.0001 * 0.9999 = 1 - 1e-8; the product of the two rounded rates is below that by less than a picosecond a second
  EXPECT_GE(clock.local_at(true_time(2_s)), local(2_s + 100_us - 10_ns) - 1_ps);
  EXPECT_LE(clock.local_at(true_time(2_s)), local(2_s + 100_us - 10_ns));
  EXPECT_EQ(clock.hardware_rate(), ppm(100));
}

TEST(LocalClock, StepsForwardsAndBackwards) {
  LocalClock clock;
  clock.step(true_time(1_s), 5_us);
  EXPECT_EQ(clock.local_at(true_time(1_s) - 1_ps), local(1_s) - 1_ps);
  EXPECT_EQ(clock.local_at(true_time(1_s)), local(1_s + 5_us));
  EXPECT_EQ(clock.true_at(local(1_s + 3_us)), true_time(1_s)) << "passed over";
  EXPECT_EQ(clock.true_at(local(1_s + 6_us)), true_time(1_s + 1_us));
  EXPECT_EQ(clock.true_at(local(1_s) - 1_ns), true_time(1_s) - 1_ns);

  clock.step(true_time(2_s), -5_us);
  EXPECT_EQ(clock.local_at(true_time(2_s)), local(2_s));
  EXPECT_EQ(clock.true_at(local(2_s)), true_time(2_s)) << "the second time that it shows this";
  EXPECT_EQ(clock.true_at(local(2_s) + 1_us), true_time(2_s) + 1_us);
  EXPECT_EQ(clock.stepped(), 0_s);
  EXPECT_EQ(clock.unstepped_at(true_time(2_s)), local(2_s));
}

TEST(LocalClock, UnsteppedTimeDoesNotJump) {
  LocalClock clock;
  clock.set_hardware_rate(TrueTime(), ppm(-50));
  clock.step(true_time(1_s), -(300_ms));
  EXPECT_EQ(clock.unstepped_at(true_time(1_s)), local(1_s - 50_us));
  EXPECT_EQ(clock.local_at(true_time(1_s)), local(700_ms - 50_us));
  EXPECT_EQ(clock.true_at_unstepped(local(1_s - 50_us)), true_time(1_s));
  EXPECT_EQ(clock.true_at_unstepped(local(2_s - 100_us)), true_time(2_s));
}

TEST(LocalClock, FractionsAreNotLostAtManyChanges) {
  LocalClock clock;
  // 10^6 changes 1 us apart that alternate between +1 and -1 ppm: each microsecond is wrong by 1 ps, every second
  // undoes it.
  for (std::int64_t i = 0; i < 1'000'000; ++i)
    clock.set_adjustment(true_time(i * 1_us), RateOffset::from({i % 2 == 0 ? 333'333 : -333'333}));
  const Duration error = clock.local_at(true_time(1_s)) - local(1_s);
  EXPECT_LE(error, 1_ps);
  EXPECT_GE(error, -(1_ps));
}

struct Counter : ClockListener {
  void clock_changed(const LocalClock& clock, TrueTime now) override { seen.push_back(clock.local_at(now)); }
  std::vector<LocalTime> seen;
};

TEST(LocalClock, TellsItsListeners) {
  LocalClock clock;
  Counter counter;
  clock.add_listener(counter);
  clock.set_hardware_rate(true_time(1_s), ppm(10));
  clock.set_hardware_rate(true_time(2_s), ppm(10));  // no change
  clock.step_and_adjust(true_time(3_s), 1_ms, RateOffset::from({5}));
  EXPECT_EQ(counter.seen, (std::vector<LocalTime>{local(1_s), local(3_s + 20_us + 1_ms)}));
  clock.remove_listener(counter);
  clock.step(true_time(4_s), 1_ms);
  EXPECT_EQ(counter.seen.size(), 2u);
  EXPECT_THROW(clock.step(true_time(3_s), 1_ms), sim::InvariantBroken) << "back in true time";
}

TEST(LocalClock, LivesToTheEndOfTime) {
  LocalClock clock;
  clock.set_hardware_rate(TrueTime(), ppm(1'000'000));
  EXPECT_EQ(clock.local_at(TrueTime::from_ps(INT64_MAX - 1)), LocalTime::never());
  EXPECT_EQ(clock.true_at(LocalTime::from_ps(INT64_MAX - 1)), TrueTime::from_ps(INT64_MAX / 2));
}

/// A clock after a few changes of rate, at instants up to 10 s; the last is returned.
TrueTime disturb(LocalClock& clock, bool with_steps) {
  const auto changes = *rc::gen::inRange(1, 6);
  TrueTime now;
  for (int i = 0; i < changes; ++i) {
    now += Duration::from_ps(*rc::gen::inRange<std::int64_t>(0, 2'000'000'000'000));
    clock.set_hardware_rate(
        now,
        ClockRate::one_plus(RateOffset::from({*rc::gen::inRange<std::int64_t>(-900'000'000'000, 1'000'000'000'000)})));
    if (with_steps) clock.step(now, Duration::from_ps(*rc::gen::inRange<std::int64_t>(-1'000'000'000, 1'000'000'000)));
  }
  return now;
}

TEST(LocalClockProperty, RoundTripsAsPromised) {
  ASSERT_TRUE(rc::check("first instant at which the clock shows a time", [] {
    LocalClock clock;
    const TrueTime last = disturb(clock, false);
    const TrueTime t = last + Duration::from_ps(*rc::gen::inRange<std::int64_t>(0, 50'000'000'000'000));
    const LocalTime shown = clock.local_at(t);
    const TrueTime first = clock.true_at(shown);
    RC_ASSERT(first <= t);
    RC_ASSERT(clock.local_at(first) == shown);
    const LocalTime l = shown + Duration::from_ps(*rc::gen::inRange<std::int64_t>(-1000, 1000));
    RC_PRE(l > clock.local_at(last) + 1_ps);
    RC_ASSERT(clock.local_at(clock.true_at(l)) >= l);
    RC_ASSERT(clock.local_at(clock.true_at(l) - 1_ps) < l);
  }));
}

TEST(LocalClockProperty, TrueAtIsMonotonousAndLiesInItsSegment) {
  ASSERT_TRUE(rc::check("over rate changes and steps", [] {
    LocalClock clock;
    const TrueTime last = disturb(clock, true);
    const LocalTime a =
        clock.local_at(last) + Duration::from_ps(*rc::gen::inRange<std::int64_t>(-2'000'000'000, 2'000'000'000));
    const LocalTime b = a + Duration::from_ps(*rc::gen::inRange<std::int64_t>(0, 1'000'000'000));
    RC_ASSERT(clock.true_at(a) <= clock.true_at(b));
    RC_ASSERT((a >= clock.local_at(last)) == (clock.true_at(a) >= last) || clock.true_at(a) == last);
    const TrueTime t = last + Duration::from_ps(*rc::gen::inRange<std::int64_t>(0, 1'000'000'000'000));
    RC_ASSERT(clock.unstepped_at(clock.true_at_unstepped(clock.unstepped_at(t))) == clock.unstepped_at(t));
  }));
}

/// What true_at() is by definition: the first instant at which the clock shows `time`.
bool is_first(const LocalClock& clock, TrueTime at, LocalTime time) {
  return clock.local_at(at) >= time && clock.local_at(at - 1_ps) < time;
}

// Most answers are those of SegmentInverse: next to the start of the segment and far behind it, at all rates.
TEST(LocalClockProperty, TrueAtIsTheFirstInstantNearAndFar) {
  ASSERT_TRUE(rc::check("near and far", [] {
    LocalClock clock;
    const TrueTime last = disturb(clock, false);
    const auto distance = std::int64_t{1} << *rc::gen::inRange(0, 58);
    const LocalTime time =
        clock.local_at(last) + 1_ps + Duration::from_ps(*rc::gen::inRange<std::int64_t>(1, distance + 1));
    RC_ASSERT(is_first(clock, clock.true_at(time), time));
  }));
}

// Segments that begin with a fraction of a picosecond, at rates that are whole, inexact, fast and slow: where the
// multiplication answers, it is right; and it does answer nearly everywhere, at rates that are not as near to a simple
// ratio as these.
TEST(SegmentInverse, IsExactOrSaysNothing) {
  constexpr std::uint64_t one = std::uint64_t{RateOffset::one};
  std::size_t silent = 0;
  std::size_t asked = 0;
  for (const std::uint64_t rate : {one / 2, one / 2 + 1, one - 1, one, one + 1, one + one / 20'000, one - one / 20'000,
                                   one + one / 3, 2 * one - 1, 2 * one}) {
    for (const std::uint64_t fraction : {std::uint64_t{0}, std::uint64_t{1}, one / 3, one / 2, one - 2, one - 1}) {
      const sim::int128 start_shows =
          (sim::int128{1'000'007} << RateOffset::fraction_bits) + static_cast<sim::int128>(fraction);
      const SegmentInverse inverse(TrueTime::from_ps(77), start_shows, ClockRate::from_multiple(rate));
      std::vector<std::int64_t> distances = {
          1, 2, 3, 20'000'000, 1'000'000'000'000, (std::int64_t{1} << 56) - 1, std::int64_t{1} << 56};
      for (std::int64_t d = 5; d < 1'000'000'000'000'000; d = 3 * d + 1) distances.push_back(d);
      for (const std::int64_t d : distances) {
        const bool is_real = rate == one + one / 20'000 || rate == one - one / 20'000;
        asked += is_real ? 1 : 0;
        const auto found = inverse.at(LocalTime::from_ps(1'000'007 + d));
        if (!found) {
          silent += is_real ? 1 : 0;
          continue;
        }
        // rate * (t - start) reaches what is missing, and a picosecond before it did not.
        const sim::int128 missing = (sim::int128{d} << RateOffset::fraction_bits) - static_cast<sim::int128>(fraction);
        const sim::int128 elapsed = found->ps() - 77;
        EXPECT_GE(elapsed * static_cast<sim::int128>(rate), missing) << rate << " " << fraction << " " << d;
        EXPECT_LT((elapsed - 1) * static_cast<sim::int128>(rate), missing) << rate << " " << fraction << " " << d;
      }
      EXPECT_FALSE(inverse.at(LocalTime::from_ps(1'000'007))) << "the start may be a step";
      EXPECT_FALSE(inverse.at(LocalTime::from_ps(5)));
      EXPECT_FALSE(inverse.at(LocalTime::never()));
    }
  }
  EXPECT_LT(silent, asked / 20) << asked;
}

TEST(SegmentInverse, SaysNothingOfRatesAndTimesThatItDoesNotKnow) {
  const LocalTime soon = local(1_us);
  EXPECT_FALSE(SegmentInverse().at(soon));
  EXPECT_TRUE(SegmentInverse(TrueTime(), 0, ClockRate::one()).at(soon));
  EXPECT_FALSE(
      SegmentInverse(TrueTime(), 0, ClockRate::from_multiple(std::uint64_t{RateOffset::one} / 2 - 1)).at(soon));
  EXPECT_FALSE(SegmentInverse(TrueTime::from_ps(INT64_MAX - 10'000'000), 0, ClockRate::one()).at(soon));
  EXPECT_FALSE(SegmentInverse(TrueTime(), sim::int128{INT64_MAX - 10} << RateOffset::fraction_bits, ClockRate::one())
                   .at(LocalTime::never()));
}

TEST(EqualSteps, AreWhatTheClockSaysOfEach) {
  ASSERT_TRUE(rc::check("after changes of rate and steps", [] {
    LocalClock clock;
    const TrueTime last = disturb(clock, true);
    const LocalTime first =
        clock.local_at(last) + Duration::from_ps(*rc::gen::inRange<std::int64_t>(-1'000'000'000, 1'000'000'000'000));
    const Duration step = Duration::from_ps(std::int64_t{1} << *rc::gen::inRange(0, 50)) +
                          Duration::from_ps(*rc::gen::inRange<std::int64_t>(0, 1000));
    EqualSteps steps = clock.steps_from(first, step);
    RC_ASSERT(steps.is_set() == (clock.true_at(first) > last));
    RC_PRE(steps.is_set());
    for (int i = 1; i <= 200; ++i) RC_ASSERT(steps.next() == clock.true_at(first + step * i));
  }));
}

TEST(EqualSteps, OfAnIdealClockAreItsOwn) {
  const LocalClock clock;
  EqualSteps steps = clock.steps_from(LocalTime(), 20_us);
  ASSERT_TRUE(steps.is_set());
  EXPECT_EQ(steps.next(), true_time(20_us));
  EXPECT_EQ(steps.next(), true_time(40_us));
  EXPECT_FALSE(EqualSteps().is_set());
  EXPECT_FALSE(clock.steps_from(LocalTime::from_ps(-1), 20_us).is_set());
  EXPECT_FALSE(clock.steps_from(LocalTime::never(), 20_us).is_set());
  EXPECT_THROW(static_cast<void>(clock.steps_from(LocalTime(), -(1_ps))), sim::InvariantBroken);
}

TEST(EqualSteps, EndWithTime) {
  LocalClock clock;
  clock.set_hardware_rate(TrueTime(), ClockRate::from_multiple(1));  // all but stands still
  EqualSteps steps = clock.steps_from(LocalTime::from_ps(3), 1_s);
  EXPECT_FALSE(steps.is_set()) << "it never shows even 3 ps";
  clock.set_hardware_rate(true_time(1_s), ppm(-500'000));
  const LocalTime first = local(1_s);
  const Duration step = Duration::from_ps(INT64_MAX / 3);
  steps = clock.steps_from(first, step);
  ASSERT_TRUE(steps.is_set());
  EXPECT_EQ(steps.next(), clock.true_at(first + step));
  EXPECT_EQ(steps.next(), TrueTime::never());
  EXPECT_EQ(clock.true_at(first + step * 2), TrueTime::never());
  EXPECT_EQ(steps.next(), TrueTime::never());
}

}  // namespace
}  // namespace takt::models::local_clock_test
