// SPDX-License-Identifier: Apache-2.0
#include "models/gptp/neighbor_rate_ratio.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace takt::models::gptp::neighbor_rate_ratio_test {
namespace {

using namespace sim::literals;
using sim::Duration;
using sim::LocalTime;
using sim::PtpTime;

PtpTime neighbor(Duration d) { return PtpTime() + d; }
LocalTime local(Duration d) { return LocalTime() + d; }
double ppm(ClockRate rate) {
  return static_cast<double>(rate.minus_one().frequency_offset().parts_per_trillion) * 1e-6;
}

TEST(NeighborRateRatio, NeedsTwoExchanges) {
  NeighborRateRatio ratio(8);
  EXPECT_FALSE(ratio.is_valid());
  ratio.add(neighbor(5_s), local(1_s));
  EXPECT_FALSE(ratio.is_valid());
  EXPECT_THROW(ratio.ratio_at(local(1_s)), sim::InvariantBroken);
  ratio.add(neighbor(6_s + 10_us), local(2_s));
  EXPECT_TRUE(ratio.is_valid());
  EXPECT_NEAR(ppm(ratio.ratio_at(local(2_s))), 10, 1e-6);
}

TEST(NeighborRateRatio, LooksBackOverItsWindow) {
  NeighborRateRatio ratio(2);
  // 0 ppm up to 10 s, then 30 ppm: after one second half of the window is new, after two all of it
  for (int i = 0; i <= 10; ++i) ratio.add(neighbor(i * 1_s), local(i * 1_s));
  ratio.add(neighbor(11_s + 30_us), local(11_s));
  EXPECT_NEAR(ppm(ratio.ratio_at(local(11_s))), 15, 1e-6);
  ratio.add(neighbor(12_s + 60_us), local(12_s));
  EXPECT_NEAR(ppm(ratio.ratio_at(local(12_s))), 30, 1e-6);
}

// A drift of 1 ppm/s: over 8 exchanges of 1 s the ratio is late by d W / 2 = 4 ppm.
TEST(NeighborRateRatio, DriftCompensationTakesTheLagAway) {
  for (const bool compensate : {false, true}) {
    NeighborRateRatio ratio(8, compensate);
    for (std::int64_t i = 0; i <= 30; ++i)
      ratio.add(neighbor(i * 1_s + Duration::from_ps(i * i * 500'000)), local(i * 1_s));
    EXPECT_NEAR(ppm(ratio.ratio_at(local(30_s))), compensate ? 30 : 26, 1e-5);
    EXPECT_NEAR(ppm(ratio.ratio_at(local(31_s))), compensate ? 31 : 26, 1e-5) << "also between exchanges";
  }
}

TEST(NeighborRateRatio, ForgetsWhatIsNotPlausible) {
  NeighborRateRatio ratio(4);
  ratio.add(neighbor(1_s), local(1_s));
  ratio.add(neighbor(2_s), local(2_s));
  ratio.add(neighbor(1_s), local(3_s));  // the neighbour's clock was set back
  EXPECT_FALSE(ratio.is_valid());
  ratio.add(neighbor(2_s), local(4_s));
  EXPECT_NEAR(ppm(ratio.ratio_at(local(4_s))), 0, 1e-6);
  ratio.add(neighbor(9_s), local(5_s));
  EXPECT_FALSE(ratio.is_valid());
}

}  // namespace
}  // namespace takt::models::gptp::neighbor_rate_ratio_test
