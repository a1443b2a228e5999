// SPDX-License-Identifier: Apache-2.0
// Credit in exact numbers, and against a shaper that steps through every picosecond.
#include "models/egress/credit_based_shaper.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>

#include "models/ethernet/sizes.hpp"

namespace takt::models {
namespace {

using namespace sim::literals;
using sim::DataRate;
using sim::Duration;
using sim::TrueTime;
using sim::operator""_Mbps;
using sim::operator""_Gbps;
using sim::operator""_B;

constexpr TrueTime at(Duration since_start) { return TrueTime() + since_start; }
constexpr CreditSlope mbps(std::int64_t n) { return {n * 1'000'000, 1}; }
/// Credit in units of 1/1000 bit, which must be whole.
std::int64_t millibits(const CreditBasedShaper& shaper, Credit credit) {
  const sim::int128 unit = shaper.units_per_bit() / 1'000;
  EXPECT_TRUE(credit.units % unit == 0);
  return static_cast<std::int64_t>(credit.units / unit);
}
std::int64_t millibits(const CreditBasedShaper& shaper, TrueTime now) { return millibits(shaper, shaper.credit(now)); }

// 1000 octets at 100 Mb/s occupy 1020 * 80 ns = 81.6 us; at -75 Mb/s that is -6120 bits, which 25 Mb/s make good in
// 244.8 us. The period of 326.4 us is 1020 octets at 25 Mb/s.
TEST(CreditBasedShaper, ABackloggedClassSendsAtItsIdleSlope) {
  CreditBasedShaper shaper(mbps(25), 100_Mbps);
  TrueTime now = at(0_us);
  shaper.frame_enqueued(now);
  for (int i = 0; i < 5; ++i) {
    EXPECT_TRUE(shaper.may_start(now));
    EXPECT_EQ(millibits(shaper, now), 0);
    shaper.transmission_started(now, 81'600_ns, false);
    EXPECT_FALSE(shaper.may_start(now + 1_us));
    EXPECT_EQ(millibits(shaper, now + 81'600_ns), -6'120'000);
    EXPECT_EQ(shaper.eligible_time(now + 1_us), now + 326'400_ns);
    EXPECT_FALSE(shaper.may_start(now + 326'400_ns - 1_ps));
    now += 326'400_ns;
  }
}

// 7588.8 bits at 7 Mb/s last 1084.1142857142857... us; the next picosecond is the first that is not too early.
TEST(CreditBasedShaper, TheEligibleTimeIsRoundedUp) {
  CreditBasedShaper shaper(mbps(7), 100_Mbps);
  shaper.frame_enqueued(at(0_us));
  shaper.transmission_started(at(0_us), 81'600_ns, false);
  const TrueTime eligible = at(81'600_ns) + 1'084'114'286_ps;
  EXPECT_EQ(shaper.eligible_time(at(0_us)), eligible);
  EXPECT_FALSE(shaper.may_start(eligible - 1_ps));
  EXPECT_TRUE(shaper.may_start(eligible));
  EXPECT_EQ(shaper.growth_needed(at(81'600_ns)), 1'084'114'286_ps);
}

// A frame waits 123.36 us for 1542 octets of another class: credit 25 * 123.36 = 3084 bits. After its own 84 octets
// (-75 * 6.72 = -504) 2580 are left; they stay only as long as another frame waits.
TEST(CreditBasedShaper, PositiveCreditIsLostWithTheLastFrame) {
  for (const bool more_wait : {true, false}) {
    CreditBasedShaper shaper(mbps(25), 100_Mbps);
    shaper.frame_enqueued(at(0_us));
    EXPECT_EQ(millibits(shaper, at(123'360_ns)), 3'084'000);
    EXPECT_EQ(shaper.hi_credit(123'360_ns), shaper.credit(at(123'360_ns)));
    shaper.transmission_started(at(123'360_ns), 6'720_ns, !more_wait);
    EXPECT_EQ(millibits(shaper, at(130'080_ns) - 1_ns), 2'580'075);
    EXPECT_EQ(millibits(shaper, at(130'080_ns)), more_wait ? 2'580'000 : 0);
  }
}

TEST(CreditBasedShaper, AnEmptyQueueRecoversToZeroAndNoFurther) {
  CreditBasedShaper shaper(mbps(25), 100_Mbps);
  shaper.frame_enqueued(at(0_us));
  shaper.transmission_started(at(0_us), 81'600_ns, true);
  EXPECT_EQ(millibits(shaper, at(181'600_ns)), -3'620'000);  // -6120 + 25 * 100
  EXPECT_EQ(millibits(shaper, at(10_s)), 0);
  shaper.frame_enqueued(at(181'600_ns));
  EXPECT_EQ(shaper.eligible_time(at(181'600_ns)), at(326'400_ns));
}

TEST(CreditBasedShaper, AFrameThatIsDroppedFromTheQueueTakesTheCreditWithIt) {
  CreditBasedShaper shaper(mbps(25), 100_Mbps);
  shaper.frame_enqueued(at(0_us));
  shaper.queue_emptied(at(100_us));
  EXPECT_EQ(millibits(shaper, at(100_us)), 0);
}

TEST(CreditBasedShaper, AClosedGateFreezesCredit) {
  CreditBasedShaper shaper(mbps(25), 100_Mbps);
  shaper.frame_enqueued(at(0_us));
  shaper.gate_closed(at(40_us));
  EXPECT_EQ(millibits(shaper, at(90_us)), 1'000'000);
  EXPECT_FALSE(shaper.may_start(at(90_us)));
  EXPECT_EQ(shaper.eligible_time(at(90_us)), TrueTime::never());
  shaper.gate_opened(at(100_us));
  EXPECT_TRUE(shaper.may_start(at(100_us)));
  shaper.transmission_started(at(100_us), 81'600_ns, false);
  shaper.gate_closed(at(180_us));  // the gap of the frame reaches beyond the close
  EXPECT_EQ(millibits(shaper, at(500_us)), 1'000'000 - 6'120'000);
  EXPECT_EQ(shaper.growth_needed(at(500_us)), 204'800_ns);
  shaper.queue_emptied(at(500_us));
  shaper.gate_opened(at(600_us));
  EXPECT_EQ(shaper.eligible_time(at(600_us)), at(804'800_ns));
}

TEST(CreditBasedShaper, PositiveCreditIsLostWithAClosedGateToo) {
  CreditBasedShaper shaper(mbps(25), 100_Mbps);
  shaper.frame_enqueued(at(0_us));
  shaper.gate_closed(at(40_us));
  shaper.queue_emptied(at(50_us));
  EXPECT_EQ(millibits(shaper, at(50_us)), 0);
}

// Two fragments with express traffic between them: 40 us of each, credit -3000, +250 in the 10 us between, -2750 -
// 3000.
TEST(CreditBasedShaper, APreemptedFrameGoesOnWithDebt) {
  CreditBasedShaper shaper(mbps(25), 100_Mbps);
  shaper.frame_enqueued(at(0_us));
  shaper.transmission_started(at(0_us), 81'600_ns, true);
  shaper.transmission_cut(at(30_us), at(40_us));
  EXPECT_EQ(millibits(shaper, at(50_us)), -2'750'000);
  shaper.transmission_resumed(at(50_us), 40_us);
  EXPECT_EQ(millibits(shaper, at(90_us)), -5'750'000);
}

// tc-cbs(8): 1 Gb/s, idleslope 20 Mb/s, 1500 octets of each: hicredit 30 octets, locredit -1470 octets.
TEST(CreditBounds, TheExampleOfTcCbs) {
  const CreditBasedShaper shaper(mbps(20), 1_Gbps);
  EXPECT_EQ(millibits(shaper, shaper.lo_credit(12_us)), -1470 * 8'000);
  EXPECT_EQ(millibits(shaper, shaper.hi_credit(12_us)), 30 * 8'000);
}

// Class A waits with class B for 1542 octets (3084 bits of credit at 25 Mb/s), then sends two of 257 octets (-1542 bits
// each) and a third with credit 0. B waits for (1542 + 3 * 257) * 80 ns = 185.04 us = 12336 bits / 75 Mb/s + 20.56 us.
TEST(CreditBounds, TheSecondClassWaitsForABurstOfTheFirst) {
  const Duration bound = second_class_interference(1542_B, 257_B, mbps(25), 100_Mbps);
  EXPECT_EQ(bound, 185'040_ns);
  CreditBasedShaper a(mbps(25), 100_Mbps), b(mbps(25), 100_Mbps);
  a.frame_enqueued(at(0_us));
  b.frame_enqueued(at(0_us));
  TrueTime now = at(123'360_ns);
  int sent = 0;
  for (; a.may_start(now); now += 20'560_ns, ++sent) a.transmission_started(now, 20'560_ns, false);
  EXPECT_EQ(sent, 3);
  EXPECT_EQ(now, at(bound));
  EXPECT_EQ(b.credit(now), b.hi_credit(bound));
  EXPECT_EQ(millibits(b, now), 4'626'000);
}

TEST(OperationalIdleSlope, IsAnExactRatio) {
  EXPECT_EQ(operational_idle_slope(20_Mbps, 300_us, 1_ms, 1_Gbps), (CreditSlope{200'000'000, 3}));
  EXPECT_EQ(operational_idle_slope(20_Mbps, 250_us, 1_ms, 1_Gbps), (CreditSlope{80'000'000, 1}));
  EXPECT_EQ(operational_idle_slope(20_Mbps, 1_ms, 1_ms, 1_Gbps), (CreditSlope{20'000'000, 1}));
  // 10 Gb/s on a denominator of 999'999'999'937 needs 74 bits: whole bit/s, 20 Mb/s * 10^12 / 999'999'999'937 rounded
  // down.
  EXPECT_EQ(operational_idle_slope(20_Mbps, 999'999'999'937_ps, 1_s, 10_Gbps), (CreditSlope{20'000'000, 1}));
}

// 200/3 Mb/s: 6.72 us at 1 Gb/s cost (1000 - 200/3) * 6.72 = 6272 bits, made good in 6272 * 3 / 200 = 94.08 us.
TEST(CreditBasedShaper, ARationalSlopeIsExact) {
  CreditBasedShaper shaper({200'000'000, 3}, 1_Gbps);
  shaper.frame_enqueued(at(0_us));
  shaper.transmission_started(at(0_us), 6'720_ns, false);
  EXPECT_EQ(millibits(shaper, at(6'720_ns)), -6'272'000);
  EXPECT_EQ(shaper.eligible_time(at(0_us)), at(6'720_ns + 94'080_ns));
  shaper.set_idle_slope(at(6'720_ns), {80'000'000, 1});
  EXPECT_EQ(millibits(shaper, at(6'720_ns)), -6'272'000);
  EXPECT_EQ(shaper.eligible_time(at(6'720_ns)), at(6'720_ns + 78'400_ns));
  shaper.set_idle_slope(at(6'720_ns), {500'000'000, 7});
  EXPECT_EQ(millibits(shaper, at(6'720_ns)), -6'272'000);
}

// 106 days of waiting do not overflow.
TEST(CreditBasedShaper, CreditOfTheLongestSimulation) {
  CreditBasedShaper shaper({10'000'000'000, 1}, 10_Gbps);
  shaper.frame_enqueued(at(0_us));
  EXPECT_TRUE(shaper.credit(TrueTime::never() - 1_ps).units > 0);
  CreditBasedShaper still({0, 1}, 10_Gbps);
  still.frame_enqueued(at(0_us));
  still.transmission_started(at(0_us), 1_us, false);
  EXPECT_EQ(still.eligible_time(at(1_us)), TrueTime::never());
}

/// The rules of 8.6.8.2 from one picosecond to the next, with a rate of a few bits a picosecond.
struct Stepper {
  std::int64_t idle = 0, send = 0;  // what a picosecond adds, in parts of a bit
  std::int64_t credit = 0;
  std::int64_t sending_for = 0;
  bool queue_empty = true, gate_open = true;

  void lose() {
    if (sending_for == 0 && queue_empty && credit > 0) credit = 0;
  }
  void step() {
    if (sending_for > 0) {
      credit += send;
      --sending_for;
    } else if (gate_open && (!queue_empty || credit < 0)) {
      credit += idle;
    }
    lose();
  }
  bool may_start() const { return sending_for == 0 && gate_open && credit >= 0; }
};

TEST(CreditBasedShaper, StepsAsTheRulesDo) {
  int started_at_rest = 0;
  const bool passed = rc::check("a shaper against the stepper", [&started_at_rest] {
    const auto number = [](std::int64_t low, std::int64_t high) {
      return *rc::gen::inRange<std::int64_t>(low, high + 1);
    };
    const std::int64_t denominator = number(1, 7), rate = number(1, 20);
    const std::int64_t numerator = number(0, rate * denominator);
    CreditBasedShaper shaper({numerator, denominator}, DataRate{static_cast<std::uint64_t>(rate)});
    const bool is_quiet = number(0, 1) == 1;  // then frames come alone
    Stepper stepper;
    stepper.idle = numerator;
    stepper.send = numerator - rate * denominator;
    for (std::int64_t ps = 0; ps < 150; ++ps) {
      const TrueTime now = TrueTime::from_ps(ps);
      const std::int64_t action = is_quiet && number(0, 39) < 39 ? 12 : number(0, 14);
      RC_LOG() << ps << ": action " << action << ", credit " << stepper.credit << '\n';
      if (action <= 3) {
        shaper.frame_enqueued(now);
        stepper.queue_empty = false;
      } else if (action == 4) {
        shaper.queue_emptied(now);
        stepper.queue_empty = true;
        stepper.lose();
      } else if (action == 5) {
        stepper.gate_open ? shaper.gate_closed(now) : shaper.gate_opened(now);
        stepper.gate_open = !stepper.gate_open;
      } else if (action <= 9 && stepper.may_start() && !stepper.queue_empty) {
        const std::int64_t occupancy = number(1, 20);
        const bool empty = number(0, 1) == 1;
        shaper.transmission_started(now, Duration::from_ps(occupancy), empty);
        stepper.sending_for = occupancy;
        stepper.queue_empty = empty;
      } else if (action == 10 && stepper.sending_for > 1) {
        const std::int64_t rest = number(1, stepper.sending_for);
        shaper.transmission_cut(now, now + Duration::from_ps(rest));
        stepper.sending_for = rest;
      } else if (action == 11 && stepper.sending_for == 0) {
        const std::int64_t occupancy = number(1, 20);
        shaper.transmission_resumed(now, Duration::from_ps(occupancy));
        stepper.sending_for = occupancy;
      } else if (action >= 12) {
        const std::int64_t occupancy = number(1, 20);
        if (stepper.queue_empty && shaper.starts_at_rest(now, Duration::from_ps(occupancy))) {
          RC_ASSERT(stepper.may_start() && stepper.credit == 0);
          stepper.sending_for = occupancy;
          ++started_at_rest;
        } else if (stepper.may_start()) {
          shaper.frame_enqueued(now);
          shaper.transmission_started(now, Duration::from_ps(occupancy), true);
          stepper.sending_for = occupancy;
          stepper.queue_empty = true;
        }
      }
      RC_ASSERT(shaper.credit(now).units == stepper.credit);
      RC_ASSERT(shaper.may_start(now) == stepper.may_start());
      const TrueTime eligible = shaper.eligible_time(now);
      Stepper later = stepper;
      for (std::int64_t ahead = 0; ahead < 400 && now + Duration::from_ps(ahead) <= eligible; ++ahead) {
        RC_ASSERT(later.may_start() == (now + Duration::from_ps(ahead) == eligible));
        RC_ASSERT(shaper.credit(now + Duration::from_ps(ahead)).units == later.credit);
        later.step();
      }
      stepper.step();
    }
  });
  EXPECT_TRUE(passed);
  EXPECT_GT(started_at_rest, 10);
}

// 1000 octets at 1 Gb/s with an idle slope of 600 Mb/s: a debt of 400 Mb/s for 8 us, which 600 Mb/s pay in 5333.3 ns.
// What is known beforehand is at most 1/256 of 8 us more.
TEST(CreditBasedShaper, RestIsKnownInTime) {
  CreditBasedShaper shaper({600'000'000, 1}, 1_Gbps);
  shaper.frame_enqueued(at(0_us));
  EXPECT_FALSE(shaper.starts_at_rest(at(0_us), 8_us));  // something waits
  shaper.transmission_started(at(0_us), 8_us, true);
  EXPECT_FALSE(shaper.starts_at_rest(at(13'333_ns), 8_us));
  EXPECT_TRUE(shaper.starts_at_rest(at(13'365_ns), 8_us));
  EXPECT_EQ(shaper.credit(at(13'365_ns)).units, 0);
  EXPECT_FALSE(shaper.starts_at_rest(at(26'698_ns), 8_us));
  EXPECT_EQ(shaper.eligible_time(at(26'698_ns)), at(26'699_ns) - Duration::from_ps(666));  // 13,365 + 13,333.334 ns
}

}  // namespace
}  // namespace takt::models
