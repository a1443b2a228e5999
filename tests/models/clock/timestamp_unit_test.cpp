// SPDX-License-Identifier: Apache-2.0
#include "models/clock/timestamp_unit.hpp"

#include <gtest/gtest.h>

namespace takt::models::timestamp_unit_test {
namespace {

using namespace sim::literals;
using sim::Duration;
using sim::LocalTime;

LocalTime local(Duration d) { return LocalTime() + d; }

TEST(TimestampUnit, IsExactByDefault) {
  sim::RandomStream chance(1, "n", "t");
  const TimestampUnit unit;
  EXPECT_EQ(unit.egress(local(1'234'567_ps), chance), local(1'234'567_ps));
  EXPECT_EQ(unit.ingress(local(1'234'567_ps), chance), local(1'234'567_ps));
}

TEST(TimestampUnit, CountsInItsGranularity) {
  sim::RandomStream chance(1, "n", "t");
  TimestampUnit unit{.granularity = 8_ns};
  EXPECT_EQ(unit.ingress(local(23'999_ps), chance), local(16_ns));
  EXPECT_EQ(unit.ingress(local(24_ns), chance), local(24_ns));
  EXPECT_EQ(unit.ingress(local(-(1_ps)), chance), local(-(8_ns))) << "down, also below zero";
  unit.grid_offset = 3_ns;
  EXPECT_EQ(unit.ingress(local(24_ns), chance), local(19_ns));
}

TEST(TimestampUnit, LatenciesVanishIfTheyAreKnown) {
  sim::RandomStream chance(1, "n", "t");
  TimestampUnit unit{
      .egress_latency = 100_ns, .ingress_latency = 260_ns, .egress_correction = 100_ns, .ingress_correction = 260_ns};
  EXPECT_EQ(unit.egress(local(5_us), chance), local(5_us));
  EXPECT_EQ(unit.ingress(local(5_us), chance), local(5_us));
  unit.egress_correction = 0_ns;
  unit.ingress_correction = 250_ns;
  EXPECT_EQ(unit.egress(local(5_us), chance), local(5_us - 100_ns));
  EXPECT_EQ(unit.ingress(local(5_us), chance), local(5_us + 10_ns));
}

TEST(TimestampUnit, JitterIsUniformAndRepeatable) {
  sim::RandomStream chance(1, "n", "t"), again(1, "n", "t");
  const TimestampUnit unit{.jitter = 4_ns};
  Duration lowest = 1_s, highest = -(1_s);
  for (int i = 0; i < 100'000; ++i) {
    const Duration error = unit.ingress(local(1_ms), chance) - local(1_ms);
    ASSERT_EQ(error, unit.ingress(local(1_ms), again) - local(1_ms));
    lowest = std::min(lowest, error);
    highest = std::max(highest, error);
  }
  EXPECT_GE(lowest, -(4_ns));
  EXPECT_LE(highest, 4_ns);
  EXPECT_LT(lowest, -(3'990_ps));
  EXPECT_GT(highest, 3'990_ps);
}

}  // namespace
}  // namespace takt::models::timestamp_unit_test
