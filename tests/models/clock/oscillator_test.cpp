// SPDX-License-Identifier: Apache-2.0
#include "models/clock/oscillator.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "models/clock/local_clock.hpp"

namespace takt::models::oscillator_test {
namespace {

using namespace sim::literals;
using sim::Duration;
using sim::LocalTime;
using sim::TrueTime;

TrueTime true_time(Duration d) { return TrueTime() + d; }
std::int64_t ppt(const Oscillator& oscillator) {
  return oscillator.rate().minus_one().frequency_offset().parts_per_trillion;
}
/// Goes on up to `until`, that instant included.
void run(Oscillator& oscillator, TrueTime until) {
  while (oscillator.next_change() <= until) oscillator.advance();
}

TEST(Oscillator, AConstantOffsetNeedsNoEvent) {
  const Oscillator oscillator({.offset = {-100'000'000}});
  EXPECT_EQ(ppt(oscillator), -100'000'000);
  EXPECT_EQ(oscillator.next_change(), TrueTime::never());
  EXPECT_EQ(Oscillator({}).rate(), ClockRate::one());
}

TEST(Oscillator, LinearDriftHasTheExactPhaseAtItsUpdates) {
  Oscillator oscillator({.drift_ppt_per_second = 1'000'000, .update_interval = 10_ms});
  LocalClock clock;
  clock.set_hardware_rate(TrueTime(), oscillator.rate());
  while (oscillator.next_change() < true_time(10_s)) {
    const TrueTime now = oscillator.next_change();
    oscillator.advance();
    clock.set_hardware_rate(now, oscillator.rate());
  }
  // 1 ppm/s for 10 s: D t^2 / 2 = 50 us
  EXPECT_EQ(clock.local_at(true_time(10_s)), LocalTime() + 10_s + 50_us);
}

TEST(Oscillator, TemperatureIsASine) {
  Oscillator oscillator({.temperature = SinusoidalFrequency{{2'000'000}, 4_s, 0}, .update_interval = 1_ms});
  for (const int quarter : {1, 3, 5}) {
    run(oscillator, true_time(quarter * 1_s));
    EXPECT_NEAR(static_cast<double>(ppt(oscillator)), quarter % 4 == 1 ? 2'000'000 : -2'000'000, 3);
  }
  run(oscillator, true_time(6'500_ms));  // phase 0.625 turns and half a millisecond
  EXPECT_NEAR(static_cast<double>(ppt(oscillator)), 2e6 * std::sin(2 * M_PI * 6.5005 / 4), 2);
}

TEST(Oscillator, PhaseShiftsTheSine) {
  const Oscillator oscillator(
      {.temperature = SinusoidalFrequency{{2'000'000}, 4_s, std::uint64_t{1} << 62}, .update_interval = 1_us});
  EXPECT_NEAR(static_cast<double>(ppt(oscillator)), 2'000'000, 1);
}

TEST(Oscillator, ATableIsLinearBetweenItsPointsAndFlatOutside) {
  OscillatorConfig config{.offset = {7}, .update_interval = 100_ms};
  config.table = {{true_time(10_s), {0}}, {true_time(20_s), {1'000'000}}, {true_time(21_s), {-500'000}}};
  Oscillator oscillator(config);
  EXPECT_EQ(ppt(oscillator), 7);
  EXPECT_EQ(oscillator.next_change(), true_time(10_s)) << "no events while it is flat";
  run(oscillator, true_time(15_s));
  EXPECT_EQ(ppt(oscillator), 505'007);  // the middle of 15 s to 15.1 s
  run(oscillator, true_time(20_s));
  EXPECT_EQ(ppt(oscillator), 925'007);
  run(oscillator, true_time(30_s));
  EXPECT_EQ(ppt(oscillator), -499'993);
  EXPECT_EQ(oscillator.next_change(), TrueTime::never());
}

TEST(Oscillator, AWalkStaysInItsBoundsAndIsAFunctionOfSeedAndPath) {
  const OscillatorConfig config{.walk = FrequencyWalk{{100}, {1'000}}, .update_interval = 1_ms};
  Oscillator a(config, 1, "bridge1"), same(config, 1, "bridge1"), other_path(config, 1, "bridge2"),
      other_seed(config, 2, "bridge1");
  std::int64_t highest = 0, lowest = 0;
  bool path_matters = false, seed_matters = false;
  for (int i = 0; i < 100'000; ++i) {
    const std::int64_t before = ppt(a);
    for (Oscillator* const each : {&a, &same, &other_path, &other_seed}) each->advance();
    EXPECT_LE(std::abs(ppt(a) - before), 100);
    ASSERT_EQ(a.rate(), same.rate());
    path_matters = path_matters || a.rate() != other_path.rate();
    seed_matters = seed_matters || a.rate() != other_seed.rate();
    highest = std::max(highest, ppt(a));
    lowest = std::min(lowest, ppt(a));
  }
  EXPECT_EQ(highest, 1'000);
  EXPECT_EQ(lowest, -1'000);
  EXPECT_TRUE(path_matters && seed_matters);
}

TEST(Oscillator, CopiesGoOnAlike) {
  Oscillator a({.walk = FrequencyWalk{{100}, {1'000}}}, 9, "x");
  a.advance();
  Oscillator b = a;
  for (int i = 0; i < 100; ++i) {
    a.advance();
    b.advance();
    ASSERT_EQ(a.rate(), b.rate());
  }
}

TEST(Oscillator, DrawsFromARange) {
  const OscillatorRange range{{-50'000'000}, {50'000'000}, -1'500'000, 1'500'000};
  double sum = 0;
  for (int i = 0; i < 1'000; ++i) {
    OscillatorConfig config, again;
    draw_oscillator(range, 5, "node" + std::to_string(i), config);
    draw_oscillator(range, 5, "node" + std::to_string(i), again);
    EXPECT_EQ(config.offset, again.offset);
    EXPECT_LE(std::abs(config.offset.parts_per_trillion), 50'000'000);
    EXPECT_LE(std::abs(config.drift_ppt_per_second), 1'500'000);
    sum += static_cast<double>(config.offset.parts_per_trillion);
  }
  EXPECT_LT(std::abs(sum / 1'000), 3e6);  // three standard errors of a uniform of +-50 ppm are 2.7 ppm
}

TEST(Oscillator, IsLimited) {
  Oscillator oscillator({.drift_ppt_per_second = 100'000'000, .bound = {150'000'000}, .update_interval = 100_ms});
  run(oscillator, true_time(5_s));
  EXPECT_EQ(ppt(oscillator), 150'000'000);
}

TEST(Oscillator, AFaultChangesItsOffset) {
  Oscillator oscillator({.offset = {10}});
  oscillator.set_offset(true_time(3_s), {20'000'000});
  EXPECT_EQ(ppt(oscillator), 20'000'000);
}

}  // namespace
}  // namespace takt::models::oscillator_test
