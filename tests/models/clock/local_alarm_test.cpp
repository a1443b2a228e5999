#include "models/clock/local_alarm.hpp"

#include <gtest/gtest.h>

#include <optional>

namespace takt::models {
namespace {

using namespace sim::literals;
using sim::Duration;
using sim::LocalTime;
using sim::TrueTime;

TrueTime true_time(Duration d) { return TrueTime() + d; }
LocalTime local(Duration d) { return LocalTime() + d; }
ClockRate ppm(std::int64_t n) { return ClockRate::one_plus(RateOffset::from({n * 1'000'000})); }

// The example: +10^6 ppm until 0.2 us shows 0.4 us, then the clock runs at its nominal rate.
TEST(LocalAlarm, SurvivesAChangeOfRate) {
  LocalClock clock;
  clock.set_hardware_rate(TrueTime(), ppm(1'000'000));
  LocalAlarm one, two;
  one.set_at(local(1_us));
  two.set_at(local(2_us));
  EXPECT_EQ(one.due(clock, TrueTime()), true_time(500_ns));
  clock.set_hardware_rate(true_time(200_ns), ppm(0));
  EXPECT_EQ(one.due(clock, true_time(200_ns)), true_time(800_ns));
  EXPECT_EQ(two.due(clock, true_time(200_ns)), true_time(1800_ns));
  EXPECT_FALSE(one.fired(clock, true_time(800_ns) - 1_ps));
  EXPECT_TRUE(one.fired(clock, true_time(800_ns)));
  EXPECT_FALSE(one.is_set());
  EXPECT_EQ(one.due(clock, true_time(800_ns)), TrueTime::never());
}

TEST(LocalAlarm, AStepPastItFiresItAtOnceAndAStepBackDelaysIt) {
  LocalClock clock;
  LocalAlarm alarm;
  alarm.set_at(local(10_us));
  clock.step(true_time(1_us), -(2_us));
  EXPECT_EQ(alarm.due(clock, true_time(1_us)), true_time(12_us));
  clock.step(true_time(3_us), 9_us);  // shows 10 us
  EXPECT_EQ(alarm.due(clock, true_time(3_us)), true_time(3_us));
  clock.step(true_time(3_us), 5_us);
  EXPECT_TRUE(alarm.fired(clock, true_time(3_us)));
}

TEST(LocalAlarm, IntervalsFollowTheRateButNoSteps) {
  LocalClock clock;
  LocalAlarm alarm;
  alarm.set_after(clock, true_time(1_ms), 10_ms);
  clock.step(true_time(2_ms), 1_s);
  EXPECT_EQ(alarm.due(clock, true_time(2_ms)), true_time(11_ms));
  clock.step(true_time(3_ms), -(5_s));
  EXPECT_EQ(alarm.due(clock, true_time(3_ms)), true_time(11_ms));
  clock.set_hardware_rate(true_time(6_ms), ppm(1'000'000));  // 5 ms are left, at twice the rate
  EXPECT_EQ(alarm.due(clock, true_time(6_ms)), true_time(8'500_us));
  EXPECT_FALSE(alarm.fired(clock, true_time(8_ms)));
  EXPECT_TRUE(alarm.fired(clock, true_time(8'500_us)));
}

TEST(LocalAlarm, InThePastFiresAtOnceAndCancelledNever) {
  LocalClock clock;
  LocalAlarm alarm;
  alarm.set_at(local(1_us));
  EXPECT_EQ(alarm.due(clock, true_time(5_us)), true_time(5_us));
  alarm.cancel();
  EXPECT_FALSE(alarm.fired(clock, true_time(5_us)));
}

/// What a component of the simulator does: one pending instant, moved whenever the clock changes.
struct Owner : ClockListener {
  void clock_changed(const LocalClock& clock, TrueTime now) override { pending = alarm.due(clock, now); }
  LocalAlarm alarm;
  TrueTime pending = TrueTime::never();
};

TEST(LocalAlarm, AListenerKeepsItRight) {
  LocalClock clock;
  Owner owner;
  clock.add_listener(owner);
  owner.alarm.set_at(local(10_ms));
  for (int i = 1; i < 9; ++i) clock.set_adjustment(true_time(i * 1_ms), RateOffset::from({i * 1'000'000}));
  // After the k-th millisecond the clock runs k ppm fast: it shows 9 ms + (1 + ... + 8) ns at 9 ms, then goes on at 8 ppm.
  const Duration left = ClockRate::one_plus(RateOffset::from({8'000'000})).divide(1_ms - 36_ns);
  EXPECT_LE(owner.pending - true_time(9_ms + left), 1_ps);
  EXPECT_GE(owner.pending - true_time(9_ms + left), -(1_ps));
  EXPECT_GE(clock.local_at(owner.pending), local(10_ms));
  EXPECT_LT(clock.local_at(owner.pending - 1_ps), local(10_ms));
}

}  // namespace
}  // namespace takt::models
