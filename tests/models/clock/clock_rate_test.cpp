// SPDX-License-Identifier: Apache-2.0
#include "models/clock/clock_rate.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "models/clock/fixed_sine.hpp"

namespace takt::models::clock_rate_test {
namespace {

using namespace sim::literals;

TEST(RateOffset, PartsPerTrillionAndBack) {
  for (const std::int64_t ppt : {0LL, 1LL, -1LL, 50'000'000LL, -999'999'999'999LL, 1'000'000'000'000LL})
    EXPECT_EQ(RateOffset::from({ppt}).frequency_offset().parts_per_trillion, ppt);
  EXPECT_EQ(RateOffset::from({1'000'000'000'000}).multiple(), RateOffset::one);
  EXPECT_THROW(RateOffset::from({1'000'000'000'001}), sim::InvariantBroken);
}

// reference: 3.0e-5 * 2^41 = 65970697.67, truncated.
TEST(RateOffset, CumulativeScaledRateOffset) {
  EXPECT_EQ(RateOffset::from({30'000'000}).scaled_41(), 65'970'697);
  EXPECT_EQ(RateOffset::from({-30'000'000}).scaled_41(), -65'970'698);  // towards minus infinity
  EXPECT_EQ(RateOffset::from({2'000'000'000}).scaled_41(), INT32_MAX);
  EXPECT_EQ(RateOffset::from({-2'000'000'000}).scaled_41(), INT32_MIN);
  for (const std::int32_t scaled : {0, 1, -1, INT32_MAX, INT32_MIN})
    EXPECT_EQ(RateOffset::from_scaled_41(scaled).scaled_41(), scaled);
}

TEST(ClockRate, ScalesDurations) {
  const ClockRate fast = ClockRate::one_plus(RateOffset::from({100'000'000}));  // +100 ppm
  EXPECT_EQ(fast.times(1_s), 1_s + 100_us);
  EXPECT_EQ(fast.divide(1_s + 100_us), 1_s);
  EXPECT_EQ(fast.times(-1_s), -(1_s + 100_us));
  EXPECT_EQ(ClockRate::ratio(1_s + 100_us, 1_s), fast);
  EXPECT_EQ(ClockRate::ratio(2_s, 1_s).times(3_s), 6_s);
  EXPECT_THROW(ClockRate::ratio(3_s, 1_s), sim::InvariantBroken);
  EXPECT_THROW(ClockRate::ratio(0_s, 1_s), sim::InvariantBroken);
}

TEST(ClockRate, ProductsAndQuotientsStayInRange) {
  const ClockRate twice = ClockRate::ratio(2_s, 1_s);
  const ClockRate half = ClockRate::ratio(1_s, 2_s);
  EXPECT_EQ(twice * half, ClockRate::one());
  EXPECT_EQ(twice * twice, twice);  // limited
  EXPECT_EQ(twice / half, twice);
  EXPECT_EQ(half / twice, ClockRate::ratio(1_s, 4_s));
  EXPECT_EQ(ClockRate::one_plus(RateOffset::from_multiple(-RateOffset::one)).multiple(), 1u);
}

TEST(FixedSine, AgreesWithLibm) {
  for (std::uint64_t i = 0; i < 4096; ++i) {
    const std::uint64_t turns = i * 0x001003'7B3A'19C5'11ULL;
    const long double angle =
        std::ldexp(static_cast<long double>(turns), -64) * 2 * 3.14159265358979323846264338327950288L;
    const long double sine = std::ldexp(static_cast<long double>(fixed_sine(turns)), -62);
    EXPECT_NEAR(static_cast<double>(sine - std::sin(angle)), 0, 1e-17) << turns;
  }
  EXPECT_EQ(fixed_sine(0), 0);
  EXPECT_NEAR(static_cast<double>(fixed_sine(std::uint64_t{1} << 62)), 0x1p62, 16);
  EXPECT_NEAR(static_cast<double>(fixed_sine(std::uint64_t{3} << 62)), -0x1p62, 16);
}

}  // namespace
}  // namespace takt::models::clock_rate_test
