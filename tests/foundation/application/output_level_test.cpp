// SPDX-License-Identifier: Apache-2.0
// Edges, pulses and periods of a digital output.
#include "application/output_level.hpp"

#include <gtest/gtest.h>

namespace takt::application::output_level_test {
namespace {

using namespace sim::literals;  // NOLINT: units

/// Sets a level with pulses of nominally 10 ms.
struct Output {
  OutputLevel<sim::LocalTime> level;
  PulseFigures figures;
  bool set(bool high, sim::Duration at) {
    const sim::LocalTime now = sim::LocalTime() + at;
    const auto edge = level.set(high, now);
    if (edge) level.count(*edge, now, 10_ms, figures);
    return edge.has_value();
  }
};

// Rises at 5, 25 and 47 ms, falls at 15 and 36.001 ms. Pulses: 10 and 11.001 ms; the second is more than 10 % off.
// Periods: 20 and 22 ms; 22 is exactly 10 % off, and regular.
TEST(OutputLevel, PulsesEndWithAFallAndPeriodsWithARise) {
  Output output;
  EXPECT_FALSE(output.set(false, 1_ms));  // it is low at the beginning
  EXPECT_TRUE(output.set(true, 5_ms));
  EXPECT_FALSE(output.set(true, 7_ms));
  EXPECT_TRUE(output.set(false, 15_ms));
  EXPECT_TRUE(output.set(true, 25_ms));
  EXPECT_TRUE(output.set(false, 36_ms + 1_us));
  EXPECT_TRUE(output.set(true, 47_ms));
  EXPECT_EQ(output.figures.pulses.count(), 2u);
  EXPECT_EQ(output.figures.pulses.least(), 10_ms);
  EXPECT_EQ(output.figures.pulses.greatest(), 11_ms + 1_us);
  EXPECT_EQ(output.figures.irregular_pulses, 1u);
  EXPECT_EQ(output.figures.periods.count(), 2u);
  EXPECT_EQ(output.figures.periods.mean(), 21_ms);
  EXPECT_EQ(output.figures.irregular_periods, 0u);
  EXPECT_TRUE(output.level.is_high());
}

}  // namespace
}  // namespace takt::application::output_level_test
