// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "gptp_fixture.hpp"

namespace takt::models::gptp::lock_test {
namespace {

using sim::Duration;

Duration magnitude(Duration d) { return d < Duration() ? -d : d; }
InstanceConfig with_priority1(std::uint8_t priority1) { return {.system = {.priority1 = priority1}}; }

/// The largest offset of `node` to node 0, looked at every 10 ms.
Duration worst_offset(Harness& harness, std::size_t node, Duration during) {
  Duration worst;
  for (Duration passed; passed < during; passed += 10_ms) {
    harness.run(10_ms);
    worst = std::max(worst, magnitude(harness.offset(node, 0)));
  }
  return worst;
}

Harness::NodeSetUp node(std::uint8_t priority1, std::int64_t ppm, Duration offset = {}) {
  return {
      .oscillator = {.offset = {ppm * 1'000'000}}, .instances = {with_priority1(priority1)}, .initial_offset = offset};
}

// Constant offsets only, exact timestamps: the error is below a nanosecond (picoseconds of rounding).
TEST(Lock, TwoNodesWithConstantOffsetsAgreeExactly) {
  Harness harness;
  harness.add(node(100, 80));
  harness.add(node(200, -70, 3_ms));
  harness.connect(0, 1, 500_ns);
  harness.start();
  harness.run(20_s);
  EXPECT_EQ(harness.station(1).target.state(), TargetState::locked);
  EXPECT_LE(worst_offset(harness, 1, 10_s), 1_ns);
  EXPECT_TRUE(harness.instance(0).is_grandmaster());
  EXPECT_EQ(harness.instance(1).role(1), PortRole::time_receiver);
  // rate of the grandmaster against the free-running clock: 1.00008 / 0.99993
  EXPECT_NEAR(
      static_cast<double>(harness.station(1).last_sample.rate_ratio.minus_one().frequency_offset().parts_per_trillion),
      (1.00008 / 0.99993 - 1) * 1e12, 5);
}

// What the grandmaster says of its time goes on as it is; who takes over says its own.
TEST(Lock, PropertiesOfTheTimeArePassedOn) {
  const TimeProperties gnss{36, 0x20, 0x3C};
  Harness harness;
  Harness::NodeSetUp first = node(100, 20);
  first.instances[0].time = gnss;
  harness.add(first);
  harness.add(node(200, -30));
  harness.add(node(250, 10));
  harness.connect(0, 1, 500_ns);
  harness.connect(1, 2, 500_ns);
  harness.start();
  harness.run(5_s);
  EXPECT_EQ(harness.instance(1).time_properties(), gnss);
  EXPECT_EQ(harness.instance(2).time_properties(), gnss);
  harness.kill(0);
  harness.run(10_s);
  EXPECT_EQ(harness.instance(1).time_properties(), TimeProperties{});
  EXPECT_EQ(harness.instance(2).time_properties(), TimeProperties{});
}

// The frequency of the second node falls by 1 ppm/s. What it adds to the rate ratio is old when the third works with
// it, but for what it says of its drift.
TEST(Lock, DriftsThatAreToldAreMadeUpFor) {
  Duration worst[2];
  for (const bool tracks : {false, true}) {
    Harness harness;
    for (std::int64_t i = 0; i < 4; ++i) {
      Harness::NodeSetUp set_up = node(static_cast<std::uint8_t>(100 + i), 0);
      if (i == 1) set_up.oscillator.drift_ppt_per_second = -1'000'000;
      set_up.send_latency = 10_ms;
      set_up.link = {.log_pdelay_req_interval = -3, .compensate_drift = tracks};
      set_up.instances[0].drift_tracking = tracks;
      harness.add(set_up);
      if (i > 0) harness.connect(static_cast<std::size_t>(i) - 1, static_cast<std::size_t>(i), 500_ns);
    }
    harness.start();
    harness.run(20_s);
    worst[tracks ? 1 : 0] = worst_offset(harness, 3, 10_s);
  }
  EXPECT_GT(worst[0], 10_ns);
  EXPECT_LT(worst[1], worst[0] / 5);
}

// Somebody sets the clock of the node between: a relay does not care, behind a boundary clock time is that clock's.
TEST(Lock, ABoundaryClockGivesTheTimeOfItsOwnClock) {
  for (const bool boundary : {false, true}) {
    Harness harness;
    harness.add(node(100, 20));
    Harness::NodeSetUp between = node(200, -30);
    between.instances[0].boundary = boundary;
    harness.add(between);
    harness.add(node(250, 10));
    harness.connect(0, 1, 500_ns);
    harness.connect(1, 2, 500_ns);
    harness.start();
    harness.run(60_s);
    EXPECT_LE(magnitude(harness.offset(2, 0)), 10_ns) << boundary;
    harness.step_clock(1, 50_us);
    harness.run(1_s);
    if (boundary) {
      EXPECT_GT(magnitude(harness.offset(2, 0)), 5_us);
    } else {
      EXPECT_LE(magnitude(harness.offset(2, 0)), 10_ns);
    }
    harness.run(120_s);
    EXPECT_LE(magnitude(harness.offset(2, 0)), 10_ns) << boundary;
  }
}

TEST(Lock, TheLinkIsMeasuredToThePicosecond) {
  Harness harness;
  harness.add(node(100, 0));
  harness.add(node(200, 0));
  harness.connect(0, 1, 123'457_ps);
  harness.start();
  harness.run(10_s);
  EXPECT_EQ(harness.station(0).machine.link(1).mean_link_delay(), 123'457_ps);
  EXPECT_EQ(harness.station(1).machine.link(1).mean_link_delay(), 123'457_ps);
}

TEST(Lock, AsymmetryGivesHalfOfItAsError) {
  for (const bool known : {false, true}) {
    Harness harness;
    harness.add(node(100, 0));
    Harness::NodeSetUp receiver = node(200, 0);
    if (known) receiver.link.delay_asymmetry = 20_ns;  // from the neighbour takes longer than the mean, by 20 ns
    harness.add(receiver);
    harness.connect(0, 1, 140_ns, 100_ns);
    harness.start();
    harness.run(30_s);
    EXPECT_EQ(harness.station(1).machine.link(1).mean_link_delay(), 120_ns);
    EXPECT_LE(magnitude(harness.offset(1, 0) + (known ? 0_ns : 20_ns)), 10_ps);
  }
}

TEST(Lock, TwoNodesWithRealTimestampsLockBelow50Nanoseconds) {
  for (const bool two_step : {true, false}) {
    Harness harness;
    for (const std::uint8_t priority1 : {std::uint8_t{100}, std::uint8_t{200}}) {
      Harness::NodeSetUp each = node(priority1, priority1 == 100 ? 40 : -35, priority1 == 100 ? 0_ms : 500_us);
      each.instances[0].two_step = two_step;
      each.timestamps = {.granularity = 8_ns, .jitter = 2_ns};
      harness.add(each);
    }
    harness.connect(0, 1, 480_ns);
    harness.start();
    harness.run(10_s);
    EXPECT_LE(worst_offset(harness, 1, 20_s), 50_ns) << two_step;
    EXPECT_GT(harness.sent[two_step ? 44 : 76], 100) << "a Sync of the right length";
  }
}

Harness line(std::size_t nodes, const Harness::NodeSetUp& pattern) {
  Harness harness;
  for (std::size_t i = 0; i < nodes; ++i) {
    Harness::NodeSetUp each = pattern;
    each.oscillator.offset = {(static_cast<std::int64_t>(i * 37 % 11) - 5) * 20'000'000};  // -100 .. 100 ppm
    each.instances[0].system.priority1 = i == 0 ? 50 : 246;
    each.initial_offset = 1_ms * static_cast<std::int64_t>(i);
    harness.add(each);
  }
  for (std::size_t i = 1; i < nodes; ++i) harness.connect(i - 1, i, 100_ns + 50_ns * static_cast<std::int64_t>(i));
  return harness;
}

TEST(Lock, ALineOfSevenBridges) {
  for (const bool two_step : {true, false}) {
    Harness::NodeSetUp pattern;
    pattern.instances[0].two_step = two_step;
    pattern.send_latency = 1_ms;  // residence and turnaround
    Harness harness = line(9, pattern);
    harness.start();
    harness.run(30_s);
    for (std::size_t i = 1; i < harness.size(); ++i) {
      EXPECT_EQ(harness.instance(i).grandmaster().root.clock, Harness::identity(0));
      EXPECT_EQ(harness.instance(i).grandmaster().steps_removed, i);
      EXPECT_LE(magnitude(harness.offset(i, 0)), 1_ns) << i;
    }
    EXPECT_EQ(harness.instance(8).path_trace().size(), 9u);
  }
}

TEST(Lock, ALineOfSevenBridgesWithRealTimestamps) {
  Harness::NodeSetUp pattern;
  pattern.timestamps = {.granularity = 8_ns, .jitter = 4_ns};
  pattern.send_latency = 1_ms;
  Harness harness = line(9, pattern);
  harness.start();
  harness.run(30_s);
  EXPECT_LE(worst_offset(harness, 8, 20_s), 500_ns);  // 802.1AS asks for 1 us over 7 hops
}

TEST(Lock, ARelayThatIsNotSyncLocked) {
  Harness::NodeSetUp pattern;
  pattern.instances[0].sync_locked = false;
  Harness harness = line(4, pattern);
  harness.start();
  harness.run(40_s);
  for (std::size_t i = 1; i < 4; ++i) EXPECT_LE(magnitude(harness.offset(i, 0)), 2_ns) << i;
  EXPECT_NEAR(harness.station(3).samples, 40 * 8, 40);
}

// Three Syncs in a row are lost once in a while: then a bridge goes on as grandmaster, by holdover, until the next
// Announce.
TEST(Lock, LostMessagesDoLittleHarm) {
  Harness harness = line(4, {});
  harness.start();
  sim::RandomStream chance(1, "link", "loss");
  harness.run(10_s);
  harness.is_lost = [&](const Message&) { return chance.below(10) == 0; };
  for (std::size_t i = 1; i < 4; ++i) EXPECT_LE(worst_offset(harness, i, 30_s), 50_ns) << i;
}

TEST(Lock, DriftTrackingIsBetterOnARamp) {
  Duration worst[2];
  for (const ServoKind kind : {ServoKind::pi, ServoKind::drift_tracking}) {
    Harness harness;
    harness.add(node(100, 0));
    Harness::NodeSetUp receiver = node(200, 0);
    receiver.oscillator.drift_ppt_per_second = 1'000'000;
    receiver.servo.kind = kind;
    harness.add(receiver);
    harness.connect(0, 1, 200_ns);
    harness.start();
    harness.run(40_s);
    worst[static_cast<std::size_t>(kind)] = worst_offset(harness, 1, 10_s);
  }
  EXPECT_NEAR(static_cast<double>(worst[0].ps()), 957e3, 15e3);
  EXPECT_LE(worst[1], 15_ns);
}

TEST(Lock, ADistantNeighbourIsNotAsCapable) {
  Harness harness;
  harness.add(node(100, 0));
  harness.add(node(200, 0));
  harness.connect(0, 1, 900_ns);
  harness.start();
  harness.run(10_s);
  EXPECT_FALSE(harness.station(1).machine.link(1).as_capable());
  EXPECT_EQ(harness.instance(1).role(1), PortRole::disabled);
  EXPECT_EQ(harness.station(1).samples, 0);
}

}  // namespace
}  // namespace takt::models::gptp::lock_test
