// SPDX-License-Identifier: Apache-2.0
#include "models/clock/servo.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "models/clock/local_clock.hpp"
#include "models/clock/oscillator.hpp"

namespace takt::models::servo_test {
namespace {

using namespace sim::literals;
using sim::Duration;
using sim::LocalTime;
using sim::TrueTime;

Duration interval_of(int log_interval) {
  return log_interval >= 0 ? 1_s * (std::int64_t{1} << log_interval) : 1_s / (std::int64_t{1} << -log_interval);
}
LocalTime local(Duration d) { return LocalTime() + d; }

TEST(ServoGains, AreThoseOfTheRule) {
  for (int n = ServoGains::lowest_log_interval; n <= ServoGains::highest_log_interval; ++n) {
    const double t = std::ldexp(1.0, n);
    const ServoGains gains = ServoGains::of_interval(n);
    EXPECT_NEAR(std::ldexp(static_cast<double>(gains.proportional), -56), std::min(0.7 * std::pow(t, -0.3), 0.7 / t),
                1e-14)
        << n;
    EXPECT_NEAR(std::ldexp(static_cast<double>(gains.integral), -56), std::min(0.3 * std::pow(t, 0.4), 0.3 / t), 1e-14)
        << n;
  }
  EXPECT_EQ(ServoGains::of_interval(-20), ServoGains::of_interval(-7));
  EXPECT_EQ(ServoGains::of_interval(20), ServoGains::of_interval(4));
}

/// A clock with an oscillator, measured exactly against true time at every interval.
struct Loop {
  Loop(const ServoConfig& config, const OscillatorConfig& oscillator_config, Duration initial)
      : oscillator(oscillator_config), servo(config), interval(interval_of(config.log_sync_interval)) {
    clock.set_hardware_rate(TrueTime(), oscillator.rate());
    if (initial != Duration()) clock.step(TrueTime(), initial);
  }
  ServoAction next() {
    now += interval;
    while (oscillator.next_change() <= now) {
      const TrueTime at = oscillator.next_change();
      oscillator.advance();
      clock.set_hardware_rate(at, oscillator.rate());
    }
    offset = clock.local_at(now).since_start() - now.since_start();
    const ServoAction action = servo.sample(offset, clock.local_at(now));
    clock.step_and_adjust(now, action.step, action.adjustment);
    return action;
  }
  void run(int samples) {
    for (int i = 0; i < samples; ++i) next();
  }
  Oscillator oscillator;
  Servo servo;
  Duration interval;
  LocalClock clock;
  TrueTime now;
  Duration offset;
};

TEST(Servo, EstimatesTheFrequencyThenJumpsThenLocks) {
  Loop loop({}, {.offset = {100'000'000}}, 3_ms);
  EXPECT_EQ(loop.next().state, ServoState::unlocked);
  const ServoAction jump = loop.next();
  EXPECT_EQ(jump.state, ServoState::jump);
  EXPECT_EQ(jump.step, -(3_ms + 25_us));  // 250 ms at 100 ppm
  // The oscillator is 100 ppm fast: 1.0001 * (1 + y) = 1, y = -99.990001 ppm
  EXPECT_NEAR(static_cast<double>(jump.adjustment.frequency_offset().parts_per_trillion), -99'990'001, 1);
  for (int i = 0; i < 20; ++i) {
    EXPECT_EQ(loop.next().state, ServoState::locked);
    EXPECT_LE(std::abs(loop.offset.ps()), 1);
  }
}

TEST(Servo, SlewsWhatIsBelowTheFirstStepThreshold) {
  Loop loop({}, {}, 20_us);
  loop.next();
  EXPECT_EQ(loop.next().state, ServoState::locked);
  loop.run(200);
  EXPECT_LE(std::abs(loop.offset.ps()), 1);
}

TEST(Servo, StepsLaterOnlyIfAsked) {
  for (const bool asked : {false, true}) {
    Loop loop({.step_threshold = asked ? 1_us : 0_us}, {}, Duration());
    loop.run(10);
    loop.clock.step(loop.now, 50_us);
    EXPECT_EQ(loop.next().state, asked ? ServoState::unlocked : ServoState::locked);
    if (!asked) continue;
    EXPECT_EQ(loop.next().state, ServoState::unlocked);
    EXPECT_EQ(loop.next().state, ServoState::jump);
    EXPECT_EQ(loop.next().state, ServoState::locked);
    EXPECT_LE(std::abs(loop.offset.ps()), 1);
  }
}

TEST(Servo, RestartKeepsTheFrequency) {
  Loop loop({}, {.offset = {10'000'000}}, Duration());
  loop.run(50);
  const RateOffset before = loop.servo.frequency();
  loop.servo.restart(true);
  EXPECT_EQ(loop.servo.holdover(10_s), -before);
  loop.clock.step(loop.now, 1_ms);
  EXPECT_EQ(loop.next().state, ServoState::unlocked);
  EXPECT_EQ(loop.next().state, ServoState::jump);
}

TEST(Servo, WaitsForALongEnoughEstimate) {
  Servo servo({.log_sync_interval = -3});  // 0.016 / 0.13058 = 122.5 ms
  servo.sample(0_ns, local(0_ms));
  EXPECT_EQ(servo.sample(1_ns, local(100_ms)).state, ServoState::unlocked);
  EXPECT_EQ(servo.sample(1_ns, local(122_ms)).state, ServoState::unlocked);
  EXPECT_EQ(servo.sample(1_ns, local(123_ms)).state, ServoState::locked);
  servo.restart(false);
  servo.sample(0_ns, local(200_ms));
  EXPECT_EQ(servo.sample(0_ns, local(150_ms)).state, ServoState::unlocked) << "local time went back";
}

TEST(Servo, IsClamped) {
  Loop loop({.first_step_threshold = 0_ns, .highest_frequency = {1'000'000}}, {}, 10_us);
  loop.run(3);
  EXPECT_EQ(loop.servo.sample(10_us, loop.clock.local_at(loop.now)).adjustment.frequency_offset().parts_per_trillion,
            -1'000'000);
  EXPECT_LE(std::abs(loop.servo.frequency().frequency_offset().parts_per_trillion), 1'000'000) << "nothing winds up";
  loop.run(1'000);
  EXPECT_LE(std::abs(loop.offset.ps()), 2);
}

TEST(Servo, LockedStableAfterEnoughSmallOffsets) {
  Loop loop({.stable_threshold = 10_ns, .stable_count = 10}, {}, Duration());
  loop.run(2);
  for (int i = 0; i < 9; ++i) EXPECT_EQ(loop.next().state, ServoState::locked);
  EXPECT_EQ(loop.next().state, ServoState::locked_stable);
  loop.clock.step(loop.now, 1_us);
  EXPECT_EQ(loop.next().state, ServoState::locked);
}

// The exact answer: linear drift D at the sync interval T leaves D T / ki, 1 ppm/s * 0.125 s / 0.130583 = 957
// ns.
TEST(Servo, PiKeepsTheKnownOffsetOnARamp) {
  Loop loop({}, {.drift_ppt_per_second = 1'000'000, .update_interval = 1_ms}, Duration());
  loop.run(800);
  EXPECT_NEAR(static_cast<double>(loop.offset.ps()) / 1000, 957.2, 9.5);
}

TEST(Servo, DriftTrackingFollowsARamp) {
  Loop loop({.kind = ServoKind::drift_tracking}, {.drift_ppt_per_second = 1'000'000, .update_interval = 1_ms},
            Duration());
  loop.run(800);
  EXPECT_LE(std::abs(loop.offset.ps()), 100);
  // 1 ppm/s * 0.125 s an interval; at +100 ppm the trim needs 1 / 1.0001^2 of that
  EXPECT_NEAR(static_cast<double>(loop.servo.drift().frequency_offset().parts_per_trillion), 124'975, 3);
  // After 8 s of holdover the frequency has gone on by 8 ppm.
  EXPECT_NEAR(
      static_cast<double>((loop.servo.holdover(0_s) - loop.servo.holdover(8_s)).frequency_offset().parts_per_trillion),
      8e6, 2e3);
}

TEST(Servo, DriftTrackingIsBetterOnASlowWaveToo) {
  Duration worst[2];
  for (const ServoKind kind : {ServoKind::pi, ServoKind::drift_tracking}) {
    Loop loop({.kind = kind}, {.temperature = SinusoidalFrequency{{10'000'000}, 120_s, 0}, .update_interval = 1_ms},
              Duration());
    loop.run(400);
    for (int i = 0; i < 960; ++i) {
      loop.next();
      Duration& most = worst[static_cast<std::size_t>(kind)];
      most = std::max(most, loop.offset < Duration() ? -loop.offset : loop.offset);
    }
  }
  EXPECT_GT(worst[0], 5 * worst[1]) << worst[0].ps() << " ps, " << worst[1].ps() << " ps";
}

TEST(Servo, BothAreStableAtEveryInterval) {
  for (const ServoKind kind : {ServoKind::pi, ServoKind::drift_tracking}) {
    for (int n = ServoGains::lowest_log_interval; n <= ServoGains::highest_log_interval; ++n) {
      Loop loop({.kind = kind, .log_sync_interval = n}, {.offset = {-30'000'000}}, 15_us);
      loop.run(4'000);
      EXPECT_LE(std::abs(loop.offset.ps()), 20) << n;
    }
  }
}

TEST(Servo, AnotherIntervalKeepsTheFrequency) {
  Loop loop({.kind = ServoKind::drift_tracking}, {.offset = {25'000'000}}, Duration());
  loop.run(100);
  const RateOffset before = loop.servo.frequency();
  loop.servo.set_log_sync_interval(0);
  EXPECT_EQ(loop.servo.frequency(), before);
  loop.interval = 1_s;
  loop.run(300);
  EXPECT_LE(std::abs(loop.offset.ps()), 2);
}

}  // namespace
}  // namespace takt::models::servo_test
