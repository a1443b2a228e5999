// SPDX-License-Identifier: Apache-2.0
#include "models/gptp/sync_information.hpp"

#include <gtest/gtest.h>

#include "models/gptp/rate_ratio_drift.hpp"

namespace takt::models::gptp::sync_information_test {
namespace {

using namespace sim::literals;
using sim::LocalTime;

ClockRate ppm(std::int64_t n) { return ClockRate::one_plus(RateOffset::from({n * 1'000'000})); }

// A hop with all its numbers: correction 500.25 ns, D = 250 ns, the neighbour 10 ppm faster, GM / upstream 1.00002.
TEST(SyncInformation, AWorkedHop) {
  FollowUpInformation tlv;
  tlv.cumulative_scaled_rate_offset = 43'980'465;
  const LocalTime ingress = LocalTime() + 1_s;
  const SyncInformation sync = SyncInformation::received({17, 5}, {32'784'384}, tlv, ingress, {250_ns, ppm(10)});
  // upstreamTx = 1 000 000 000 - 250 / 1.00001 = 999 999 750.0025 ns
  EXPECT_EQ(sync.since.ps(), 999'999'750'002);
  EXPECT_NEAR(static_cast<double>(sync.rate_ratio.minus_one().frequency_offset().parts_per_trillion), 30'000'000, 1);
  EXPECT_EQ(sync.handed_on(sync.since).cumulative_scaled_rate_offset, 65'970'697);
  // residence with link 1 200 249.9975 ns * 1.00003 = 1 200 286.005 ns; + 500.25
  EXPECT_EQ(sync.correction_at(ingress + 1'200_us).duration(), 1'200'786'255_ps);
  EXPECT_EQ(sync.origin, (Timestamp{17, 5}));
  // at the end: origin + 500.25 + 250 * 1.00003 / 1.00001
  EXPECT_EQ(sync.grandmaster_time_at(ingress).ps(), 17'000'000'005'000 + 500'250 + 250'005);
}

// 1 ppm/s over a second: the ratio grows by 1 ppm, the time by half a microsecond.
TEST(SyncInformation, DriftOnTheWay) {
  SyncInformation sync{.since = LocalTime() + 5_s, .rate_ratio = ppm(20), .drift = RateOffset::from({1'000'000})};
  EXPECT_EQ(sync.correction_at(LocalTime() + 6_s).duration(), 1_s + 20'500_ns);
  EXPECT_EQ(sync.handed_on(LocalTime() + 6_s).cumulative_scaled_rate_offset, ppm(21).minus_one().scaled_41());
}

TEST(RateRatioDrift, IsTheSlopeOfTheLastSyncs) {
  RateRatioDrift drift(4), none(0);
  for (std::int64_t i = 0; i < 20; ++i) {
    EXPECT_EQ(drift.per_second() == RateOffset(), i < 4) << i;
    drift.add(LocalTime() + i * 125_ms, ClockRate::one_plus(RateOffset::from({(50 - i) * 250'000})));
    none.add(LocalTime() + i * 125_ms, ClockRate::one());
  }
  EXPECT_EQ(drift.per_second().frequency_offset().parts_per_trillion, -2'000'000);
  EXPECT_EQ(none.per_second(), RateOffset());
  drift.reset();
  EXPECT_EQ(drift.per_second(), RateOffset());
}

TEST(SourceTime, WholeNanosecondsAndTheRest) {
  const SourceTime source{LocalTime() + 5_s, sim::PtpTime() + 9_s + 300_ps, ppm(100), 4};
  const SyncInformation sync = source.information_at(LocalTime() + 6_s);
  EXPECT_EQ(sync.origin, (Timestamp{10, 100'000}));
  EXPECT_EQ(sync.correction.duration(), 300_ps);
  EXPECT_EQ(sync.grandmaster_time_at(LocalTime() + 7_s), source.time_at(LocalTime() + 7_s));
  EXPECT_EQ(sync.information.gm_time_base_indicator, 4);
}

}  // namespace
}  // namespace takt::models::gptp::sync_information_test
