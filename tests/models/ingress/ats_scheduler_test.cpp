// SPDX-License-Identifier: Apache-2.0
// Eligibility times worked by hand, and against a token bucket that is written the other way round.
#include "models/ingress/ats_scheduler.hpp"

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <algorithm>
#include <cstdint>
#include <optional>
#include <tuple>
#include <vector>

namespace takt::models::ats_scheduler_test {
namespace {

using namespace sim::literals;
using sim::DataRate;
using sim::Duration;
using sim::int128;
using sim::LocalTime;
using sim::Octets;
using sim::operator""_Mbps;
using sim::operator""_B;

constexpr LocalTime local(Duration since_start) { return LocalTime() + since_start; }

// CIR 100 Mb/s, CBS 16000 bits (160 us to fill), frames of 1000 octets (8000 bits, 80 us):
//   start  BucketEmptyTime = -160 us
//   1  at 0: scheduler eligibility -80, bucket full 0: eligible at 0; not before full, so empty time -80 + (0 - 0) =
//   -80 2  at 0: scheduler eligibility 0, full 80: eligible at 0; empty time 0 3  at 0: scheduler eligibility 80:
//   eligible at 80; empty time 80 4  at 1 ms: scheduler eligibility 160, full 240: eligible at 1000; empty time 160 +
//   (1000 - 240) = 920
TEST(AtsScheduler, WorkedExample) {
  AtsScheduler scheduler(100_Mbps, 16'000);
  AtsGroup group;
  EXPECT_EQ(scheduler.bucket_empty_time(), LocalTime() - 160_us);
  EXPECT_EQ(scheduler.process(1000_B, local(0_us), group), local(0_us));
  EXPECT_EQ(scheduler.bucket_empty_time(), LocalTime() - 80_us);
  EXPECT_EQ(scheduler.process(1000_B, local(0_us), group), local(0_us));
  EXPECT_EQ(scheduler.bucket_empty_time(), local(0_us));
  EXPECT_EQ(scheduler.process(1000_B, local(0_us), group), local(80_us));
  EXPECT_EQ(scheduler.bucket_empty_time(), local(80_us));
  EXPECT_EQ(scheduler.process(1000_B, local(1_ms), group), local(1_ms));
  EXPECT_EQ(scheduler.bucket_empty_time(), local(920_us));
  EXPECT_EQ(group.group_eligibility_time, local(1_ms));
  EXPECT_EQ(group.discarded_frames, 0u);
}

TEST(AtsScheduler, SaysWhatItWasMadeWith) {
  const AtsScheduler scheduler(100_Mbps, 16'001, local(1_ms));
  EXPECT_EQ(scheduler.committed_information_rate(), 100_Mbps);
  EXPECT_EQ(scheduler.committed_burst_size_bits(), 16'001u);
  EXPECT_EQ(scheduler.bucket_empty_time(), local(839'990_ns));  // 1 ms - 160.01 us
}

// A frame that would wait for 80 us, with 79.999999 us allowed, is discarded and leaves everything as it was: with 80
// us it goes.
TEST(AtsScheduler, ADiscardedFrameChangesNothing) {
  AtsScheduler scheduler(100_Mbps, 8'000);
  AtsGroup group;
  group.maximum_residence_time = 80_us - 1_ps;
  EXPECT_EQ(scheduler.process(1000_B, local(0_us), group), local(0_us));
  EXPECT_EQ(scheduler.process(1000_B, local(0_us), group), std::nullopt);
  EXPECT_EQ(scheduler.process(1000_B, local(0_us), group), std::nullopt);
  EXPECT_EQ(group.discarded_frames, 2u);
  EXPECT_EQ(group.group_eligibility_time, local(0_us));
  EXPECT_EQ(scheduler.bucket_empty_time(), local(0_us));
  group.maximum_residence_time = 80_us;
  EXPECT_EQ(scheduler.process(1000_B, local(0_us), group), local(80_us));
}

// The second stream has a full bucket, but its frame comes after one of the group that must wait: order is kept. Its
// bucket overflows meanwhile, so it is full again (less the frame) when the frame goes.
TEST(AtsScheduler, AGroupKeepsItsOrder) {
  AtsScheduler slow(100_Mbps, 8'000);
  AtsScheduler fast(100_Mbps, 8'000);
  AtsGroup group;
  EXPECT_EQ(slow.process(1000_B, local(0_us), group), local(0_us));
  EXPECT_EQ(slow.process(1000_B, local(0_us), group), local(80_us));
  EXPECT_EQ(fast.process(500_B, local(1_us), group), local(80_us));
  EXPECT_EQ(fast.bucket_empty_time(), local(40_us));  // 4000 of 8000 bits left at 80 us
  AtsGroup other;
  EXPECT_EQ(AtsScheduler(100_Mbps, 8'000).process(500_B, local(1_us), other), local(1_us));
}

// At 3 Mb/s an octet lasts 2666666.67 ps. With a bucket of one octet, octet k is eligible at k * 8 / 3 us, rounded up,
// and the thirds that are rounded do not add up: octet 3n is exactly at 8n us.
TEST(AtsScheduler, RoundsUpAndLosesNothing) {
  AtsScheduler scheduler(3_Mbps, 8);
  AtsGroup group;
  for (std::int64_t k = 0; k < 30'000; ++k) {
    const LocalTime expected = LocalTime::from_ps((k * 8'000'000 + 2) / 3);
    ASSERT_EQ(scheduler.process(1_B, local(0_us), group), expected) << k;
  }
}

TEST(AtsScheduler, TheBucketOverflowsWithoutRounding) {
  AtsScheduler scheduler(3_Mbps, 8);
  AtsGroup group;
  EXPECT_EQ(scheduler.process(1_B, local(0_us), group), local(0_us));
  EXPECT_EQ(scheduler.process(1_B, local(2'666'667_ps), group), local(2'666'667_ps));  // overflowed by a third of a ps
  EXPECT_EQ(scheduler.process(1_B, local(2'666'667_ps), group), local(5'333'334_ps));  // 2666667 + 2666666.67
}

TEST(AtsScheduler, ExtremesDoNotOverflow) {
  AtsScheduler slow({1}, std::uint64_t{1} << 56);
  AtsScheduler fast({1'000'000'000'000}, 8);
  AtsGroup group;
  const LocalTime late = LocalTime::from_ps(std::int64_t{1} << 62);
  EXPECT_EQ(slow.process({0xFFFF'FFFF}, late, group), late);
  EXPECT_EQ(fast.process(1_B, late, group), late);
  EXPECT_EQ(fast.process(1_B, late, group), late + 8_ps);
  // A second a bit and no burst: 10^6 octets last 8 * 10^18 ps; 10^9 more would be eligible after the end of time.
  AtsScheduler slowest({1}, 0);
  EXPECT_EQ(slowest.process({1'000'000}, late, group), LocalTime::from_ps(8'000'000'000'000'000'000));
  EXPECT_EQ(slowest.process({1'000'000'000}, late, group), std::nullopt);
}

// The oracle fills a bucket with tokens (in 10^-12 bit) as time goes by (in 1 ps / rate) and looks for the first
// instant with enough of them, and then for the first picosecond not before it.
class TokenBucket {
 public:
  TokenBucket(std::int64_t rate, std::int64_t burst) : rate_(rate), burst_(int128{burst} * scale), tokens_(burst_) {}

  std::optional<std::int64_t> process(std::int64_t bits, std::int64_t arrival, std::int64_t& group,
                                      std::int64_t residence) {
    const int128 need = int128{bits} * scale;
    int128 when = rate_ * std::max(arrival, group);
    when += std::max(int128{0}, need - tokens_at(when));  // one token comes in 1 ps / rate
    const auto picosecond = static_cast<std::int64_t>((when + rate_ - 1) / rate_);
    if (picosecond - arrival > residence) return std::nullopt;
    tokens_ = tokens_at(when) - need;
    last_ = when;
    group = picosecond;
    return picosecond;
  }

 private:
  static constexpr std::int64_t scale = 1'000'000'000'000;
  int128 tokens_at(int128 when) const { return std::min(burst_, tokens_ + (when - last_)); }

  int128 rate_;
  int128 burst_;
  int128 tokens_;
  int128 last_ = 0;
};

TEST(AtsScheduler, AgreesWithATokenBucket) {
  const bool agrees =
      rc::check("ATS eligibility = first instant with enough tokens, rounded up, ascending in the group", [] {
        const std::int64_t longest = *rc::gen::inRange<std::int64_t>(1, 1'600);
        const std::int64_t residence = *rc::gen::element<std::int64_t>(0, 50'000'000, 1'000'000'000, INT64_MAX);
        AtsGroup group;
        group.maximum_residence_time = Duration::from_ps(residence);
        std::int64_t oracle_group = 0;
        std::vector<AtsScheduler> schedulers;
        std::vector<TokenBucket> oracles;
        for (int i = 0; i < 3; ++i) {
          const std::int64_t rate = *rc::gen::inRange<std::int64_t>(1'000'000, 1'000'000'007);
          const std::int64_t burst = longest * 8 + *rc::gen::inRange<std::int64_t>(0, 20'000);
          schedulers.emplace_back(DataRate{static_cast<std::uint64_t>(rate)}, static_cast<std::uint64_t>(burst));
          oracles.emplace_back(rate, burst);
        }
        std::int64_t now = 0;
        const auto frames = *rc::gen::container<std::vector<std::tuple<int, std::int64_t, std::int64_t>>>(
            rc::gen::tuple(rc::gen::inRange(0, 3), rc::gen::inRange<std::int64_t>(1, longest + 1),
                           rc::gen::inRange<std::int64_t>(0, 30'000'000)));
        for (const auto& [which, octets, gap] : frames) {
          now += gap;
          const auto index = static_cast<std::size_t>(which);
          const auto expected = oracles[index].process(octets * 8, now, oracle_group, residence);
          const auto found =
              schedulers[index].process({static_cast<std::uint32_t>(octets)}, LocalTime::from_ps(now), group);
          RC_ASSERT(found.has_value() == expected.has_value());
          if (found) RC_ASSERT(found->ps() == *expected);
          RC_ASSERT(group.group_eligibility_time.ps() == oracle_group);
        }
      });
  EXPECT_TRUE(agrees);
}

}  // namespace
}  // namespace takt::models::ats_scheduler_test
