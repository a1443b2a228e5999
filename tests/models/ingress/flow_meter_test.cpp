// SPDX-License-Identifier: Apache-2.0
// Colours worked by hand, and against MEF 10.3 written down in rational numbers.
#include "models/ingress/flow_meter.hpp"

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <algorithm>
#include <boost/multiprecision/cpp_int.hpp>
#include <tuple>
#include <vector>

namespace takt::models::flow_meter_test {
namespace {

using namespace sim::literals;
using sim::Duration;
using sim::LocalTime;
using sim::Octets;
using sim::operator""_Mbps;
using sim::operator""_B;
using Verdict = FlowMeter::Verdict;

constexpr LocalTime local(Duration since_start) { return LocalTime() + since_start; }
constexpr Verdict green{FrameColor::green, true, false};
constexpr Verdict yellow{FrameColor::yellow, true, true};
constexpr Verdict red{FrameColor::red, false, false};

/// CIR 8 Mb/s (1 octet a microsecond), CBS 1000; EIR 16 Mb/s (2 octets a microsecond), EBS 500.
FlowMeterConfig example() {
  FlowMeterConfig config;
  config.committed_information_rate = 8_Mbps;
  config.committed_burst_size = 1000_B;
  config.excess_information_rate = 16_Mbps;
  config.excess_burst_size = 500_B;
  return config;
}

// Full buckets 1000/500. 600: green, 400/500. 500: yellow, 400/0. 401: red. 200 us later: 600/400 (excess has come to
// 400). 600: green, 0/400. 400: yellow, 0/0. 1: red.
TEST(FlowMeter, WorkedExample) {
  FlowMeter meter(example());
  EXPECT_EQ(meter.meter(600_B, false, local(0_us)), green);
  EXPECT_EQ(meter.meter(500_B, false, local(0_us)), yellow);
  EXPECT_EQ(meter.meter(401_B, false, local(0_us)), red);
  EXPECT_EQ(meter.committed_tokens(), 400_B);
  EXPECT_EQ(meter.excess_tokens(), 0_B);
  EXPECT_EQ(meter.meter(600_B, false, local(200_us)), green);
  EXPECT_EQ(meter.excess_tokens(), 400_B);
  EXPECT_EQ(meter.meter(400_B, false, local(200_us)), yellow);
  EXPECT_EQ(meter.meter(1_B, false, local(200_us)), red);
}

// Both buckets empty at 0; 1500 us bring 1500 committed octets, of which 500 overflow. With EIR 0 the excess bucket
// gets just those, if coupled.
TEST(FlowMeter, TheCouplingFlagHandsOverflowOn) {
  for (const bool coupled : {false, true}) {
    FlowMeterConfig config = example();
    config.excess_information_rate = {};
    config.coupling_flag = coupled;
    FlowMeter meter(config);
    EXPECT_EQ(meter.meter(1000_B, false, local(0_us)), green);
    EXPECT_EQ(meter.meter(500_B, false, local(0_us)), yellow);
    EXPECT_EQ(meter.meter(1000_B, false, local(1'400_us)), green);
    EXPECT_EQ(meter.excess_tokens(), coupled ? 400_B : 0_B);
  }
}

TEST(FlowMeter, ColorAwareTakesYellowFramesFromTheExcessBucket) {
  FlowMeterConfig config = example();
  FlowMeter blind(config);
  EXPECT_EQ(blind.meter(100_B, true, local(0_us)), (Verdict{FrameColor::green, true, true}));  // its DEI stays
  config.color_mode = ColorMode::color_aware;
  FlowMeter aware(config);
  EXPECT_EQ(aware.meter(100_B, true, local(0_us)), yellow);
  EXPECT_EQ(aware.committed_tokens(), 1000_B);
  EXPECT_EQ(aware.meter(401_B, true, local(0_us)), (Verdict{FrameColor::red, false, true}));
  EXPECT_EQ(aware.meter(401_B, false, local(0_us)), green);
}

TEST(FlowMeter, DropOnYellow) {
  FlowMeterConfig config = example();
  config.drop_on_yellow = true;
  FlowMeter meter(config);
  EXPECT_EQ(meter.meter(1000_B, false, local(0_us)), green);
  EXPECT_EQ(meter.meter(500_B, false, local(0_us)), (Verdict{FrameColor::yellow, false, true}));
  EXPECT_EQ(meter.excess_tokens(), 0_B);
}

TEST(FlowMeter, MarkAllFramesRedLatchesUntilCleared) {
  FlowMeterConfig config = example();
  config.mark_all_frames_red_enable = true;
  FlowMeter meter(config);
  EXPECT_EQ(meter.meter(1501_B, false, local(0_us)), red);
  EXPECT_TRUE(meter.mark_all_frames_red());
  EXPECT_EQ(meter.meter(1_B, false, local(0_us)), red);
  EXPECT_EQ(meter.meter(1_B, false, local(1_s)), red);
  meter.clear_mark_all_frames_red();
  EXPECT_EQ(meter.meter(1000_B, false, local(1_s)), green);
  EXPECT_FALSE(meter.mark_all_frames_red());

  FlowMeter without(example());
  EXPECT_EQ(without.meter(1501_B, false, local(0_us)), red);
  EXPECT_FALSE(without.mark_all_frames_red());
  EXPECT_EQ(without.meter(1_B, false, local(0_us)), green);
}

TEST(FlowMeter, AYellowDropLatchesToo) {
  FlowMeterConfig config = example();
  config.drop_on_yellow = true;
  config.mark_all_frames_red_enable = true;
  FlowMeter meter(config);
  meter.meter(1000_B, false, local(0_us));
  EXPECT_FALSE(meter.mark_all_frames_red());
  meter.meter(1_B, false, local(0_us));
  EXPECT_TRUE(meter.mark_all_frames_red());
}

// 3 b/s bring an octet in 2.67 s. Asked every picosecond-odd instant, nothing is lost: after 8 s there are exactly
// three octets.
TEST(FlowMeter, FractionsOfAnOctetAreKept) {
  FlowMeterConfig config;
  config.committed_information_rate = {3};
  config.committed_burst_size = 3_B;
  FlowMeter meter(config);
  EXPECT_EQ(meter.meter(3_B, false, local(0_s)), green);
  for (int i = 1; i < 8'000; ++i) EXPECT_EQ(meter.meter(4_B, false, local(1_ms * i - 1_ps * (i % 7))), red);
  EXPECT_EQ(meter.meter(3_B, false, local(8_s - 1_ps)), red);
  EXPECT_EQ(meter.meter(3_B, false, local(8_s)), green);
}

TEST(FlowMeter, TimeThatRunsBackwardsBringsNothing) {
  FlowMeter meter(example());
  EXPECT_EQ(meter.meter(1000_B, false, local(10_ms)), green);
  EXPECT_EQ(meter.meter(500_B, false, local(5_ms)), yellow);
  EXPECT_EQ(meter.meter(1_B, false, local(5_ms)), red);
  EXPECT_EQ(meter.meter(100_B, false, local(5_ms + 100_us)), green);
}

TEST(FlowMeter, ExtremesDoNotOverflow) {
  FlowMeterConfig config;
  config.committed_information_rate = config.excess_information_rate = {1'000'000'000'000};
  config.committed_burst_size = config.excess_burst_size = {0xFFFF'FFFF};
  config.coupling_flag = true;
  FlowMeter meter(config);
  EXPECT_EQ(meter.meter({0xFFFF'FFFF}, false, local(0_s)), green);
  EXPECT_EQ(meter.meter({0xFFFF'FFFF}, false, local(0_s)), yellow);
  EXPECT_EQ(meter.meter({0xFFFF'FFFF}, false, LocalTime::never()), green);
  EXPECT_EQ(meter.meter({0xFFFF'FFFF}, false, LocalTime::never()), yellow);
}

// MEF 10.3 as the reference writes it, in rational numbers of octets and seconds.
TEST(FlowMeter, AgreesWithRationalArithmetic) {
  using Rational = boost::multiprecision::cpp_rational;
  const bool agrees = rc::check("flow meter = MEF 10.3 in rationals", [] {
    FlowMeterConfig config;
    const auto rate = [] {
      return sim::DataRate{*rc::gen::element<std::uint64_t>(0, 999'983, 10'000'000, 777'777'777, 1'000'000'000)};
    };
    const auto burst = [] { return Octets{*rc::gen::inRange<std::uint32_t>(0, 4'000)}; };
    config.committed_information_rate = rate();
    config.excess_information_rate = rate();
    config.committed_burst_size = burst();
    config.excess_burst_size = burst();
    config.coupling_flag = *rc::gen::arbitrary<bool>();
    config.color_mode = *rc::gen::element(ColorMode::color_blind, ColorMode::color_aware);
    if (*rc::gen::arbitrary<bool>()) {  // committed tokens alone have a short way
      config.excess_burst_size = {};
      config.color_mode = ColorMode::color_blind;
    }
    FlowMeter meter(config);

    const Rational cir(config.committed_information_rate.bits_per_second),
        eir(config.excess_information_rate.bits_per_second);
    const Rational cbs(config.committed_burst_size.count), ebs(config.excess_burst_size.count);
    Rational bc = cbs, be = ebs;
    std::int64_t now = 0;
    const auto frames = *rc::gen::container<std::vector<std::tuple<std::uint32_t, bool, std::int64_t>>>(
        rc::gen::tuple(rc::gen::inRange<std::uint32_t>(1, 1'600), rc::gen::arbitrary<bool>(),
                       rc::gen::inRange<std::int64_t>(0, 40'000'000)));
    for (const auto& [length, dei, gap] : frames) {
      now += gap;
      const Rational dt = Rational(gap) / Rational(1'000'000'000'000);
      const Rational filled = bc + cir / 8 * dt;
      const Rational o = std::max(Rational(0), Rational(filled - cbs));
      bc = std::min(cbs, filled);
      be = std::min(ebs, Rational(be + eir / 8 * dt + (config.coupling_flag ? o : Rational(0))));
      const bool arrives_green = config.color_mode == ColorMode::color_blind || !dei;
      FrameColor expected = FrameColor::red;
      if (arrives_green && length <= bc) {
        expected = FrameColor::green;
        bc -= length;
      } else if (length <= be) {
        expected = FrameColor::yellow;
        be -= length;
      }
      RC_ASSERT(meter.meter({length}, dei, LocalTime::from_ps(now)).color == expected);
    }
  });
  EXPECT_TRUE(agrees);
}

}  // namespace
}  // namespace takt::models::flow_meter_test
