// SPDX-License-Identifier: Apache-2.0
// Enhanced transmission selection: whose turn it is, frame by frame, and at a port with everything else.
#include "models/egress/deficit_round_robin.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "sim/random.hpp"
#include "tests/models/network_fixture.hpp"
#include "tests/wire_checker/share_account.hpp"

namespace takt::models {
namespace {

using namespace test;
using PerClass = DeficitRoundRobin::PerClass;

/// The classes that send, one behind the other; all those that are listed have frames of these lengths at all times.
std::string sent(DeficitRoundRobin& round, const PerClass& lengths, std::size_t frames) {
  std::string order;
  for (std::size_t i = 0; i < frames; ++i) {
    const TrafficClass q = round.choose(lengths);
    round.started(q, lengths[q], false);
    order += static_cast<char>('0' + q);
  }
  return order;
}

// 75 and 25 octets a round, frames of 100: class 2 has 75, 150, 125, 100 when its turn comes, and class 1 has 25, 50,
// 75, 100.
TEST(DeficitRoundRobin, OrderByHand) {
  DeficitRoundRobin round({0, 25, 75});
  EXPECT_EQ(sent(round, {0, 100, 100}, 12), "222122212221");
}

// After 1,000 rounds class 1 has been given 30,000 octets and class 2 70,000, and frames of 100 have used them up.
TEST(DeficitRoundRobin, OctetsAreInProportion) {
  DeficitRoundRobin round({0, 30, 70});
  const std::string order = sent(round, {0, 100, 100}, 1000);
  EXPECT_EQ(std::count(order.begin(), order.end(), '1'), 300);
  EXPECT_EQ(std::count(order.begin(), order.end(), '2'), 700);
  // Octets count, not frames: 50 frames of 1,400 octets are as much as 1,000 of 70.
  DeficitRoundRobin halves({50, 50});
  const std::string mixed = sent(halves, {1400, 70}, 1050);
  EXPECT_EQ(std::count(mixed.begin(), mixed.end(), '0'), 50);
}

// Class 3 has half, and nothing to send: 30 to 20 is 3 to 2.
TEST(DeficitRoundRobin, TheShareOfAnIdleClassGoesToTheOthers) {
  DeficitRoundRobin round({0, 20, 30, 50});
  const std::string order = sent(round, {0, 100, 100, 0}, 500);
  EXPECT_EQ(std::count(order.begin(), order.end(), '1'), 200);
  EXPECT_EQ(std::count(order.begin(), order.end(), '2'), 300);
  EXPECT_EQ(sent(round, {0, 100}, 3), "111");
}

// Class 2 has 50 octets left when its queue is empty, and begins at 0 when it comes back. So it needs two rounds for
// 100 octets, as class 1 does, which is visited before it; with the 50 it would need one.
TEST(DeficitRoundRobin, WhoHasNothingToSendSavesNothing) {
  DeficitRoundRobin round({0, 25, 75});
  EXPECT_EQ(round.choose({0, 100, 100}), 2);
  round.started(2, 100, true);
  EXPECT_EQ(round.choose({0, 60, 100}), 1);  // class 1 has 25
  // The same if what waits is dropped: two rounds later class 1 has 75.
  EXPECT_EQ(round.choose({0, 1000, 100}), 2);
  round.started(2, 100, false);
  round.emptied(2);
  EXPECT_EQ(round.choose({0, 110, 100}), 1);
}

// What might be sent changes nothing until it is sent.
TEST(DeficitRoundRobin, ChoosingTakesNoTurn) {
  DeficitRoundRobin round({0, 25, 75});
  for (int i = 0; i < 5; ++i) EXPECT_EQ(round.choose({0, 100, 0}), 1);
  EXPECT_EQ(sent(round, {0, 100, 100}, 8), "22212221");
}

// Against the algorithm as it is written, visit by visit: any percentages, lengths, and classes that may start.
TEST(DeficitRoundRobin, JumpsOverEmptyRoundsAsIfItWentThroughThem) {
  sim::RandomStream chance(1, "deficit round robin", "test");
  for (int trial = 0; trial < 200; ++trial) {
    PerClass quanta{};
    ShapingConfig config;
    for (TrafficClass q = 0; q < traffic_class_count; ++q) {
      if (q != 3 && chance.below(2) == 0) continue;
      quanta[q] = 1 + static_cast<std::int64_t>(chance.below(100));
      config.selection[q] = EnhancedTransmissionSelection{static_cast<std::uint8_t>(quanta[q])};
    }
    DeficitRoundRobin round(quanta);
    wire_checker::ShareAccount literal(config);
    PerClass waiting{};  // the first frame of each queue
    for (int step = 0; step < 300; ++step) {
      PerClass heads{};
      for (TrafficClass q = 0; q < traffic_class_count; ++q) {
        if (quanta[q] == 0) continue;
        if (waiting[q] == 0 && (q == 3 || chance.below(3) == 0))
          waiting[q] = 84 + static_cast<std::int64_t>(chance.below(1459));
        if (q == 3 || chance.below(5) != 0) heads[q] = waiting[q];  // some gates are closed
      }
      const TrafficClass q = round.choose(heads);
      ASSERT_EQ(q, literal.next(heads)) << "trial " << trial << ", step " << step;
      const bool is_last = chance.below(3) == 0;
      round.started(q, heads[q], is_last);
      literal.pay(q, heads[q]);
      if (is_last) literal.empty(q);
      waiting[q] = is_last ? 0 : 84 + static_cast<std::int64_t>(chance.below(1459));
    }
  }
}

/// Two hosts at a link of 1 Gb/s, where a minimum frame occupies 84 octets, 672 ns. Class 2 has 75 % and class 1 25 %.
struct SharedLink {
  SharedLink() : talker(builder.host("talker")), listener(builder.host("listener")) {
    PortConfig config;
    config.traffic_class_of_priority = identity_traffic_classes;
    config.shaping.selection[2] = EnhancedTransmissionSelection{75};
    config.shaping.selection[1] = EnhancedTransmissionSelection{25};
    builder.plan.port_configs[0] = config;
    builder.link(talker, listener, 1_Gbps);
  }
  PortConfig& config() { return builder.plan.port_configs[0]; }
  void send(Priority priority, std::size_t frames, Duration time) {
    const StreamIndex stream = builder.stream(talker, {listener}, {priority, 0, Octets{0}});
    builder.send_at(stream, 0_B, std::vector<Duration>(frames, time));
  }
  /// The classes as they start.
  std::string order(std::uint64_t tie_shuffle = 0) {
    NetworkRun run(builder.plan, 1, tie_shuffle);
    TraceLog log;
    run.simulation.set_trace(&log);
    run.until(1_ms);
    std::string order;
    for (const sim::TraceRecord& record : log.of(Occurrence::started))
      order += static_cast<char>('0' + TransmissionDetail::unpack(record.detail).traffic_class);
    return order;
  }
  PlanBuilder builder;
  NodeIndex talker;
  NodeIndex listener;
};

// Eight frames of each class at once, and one of a class without a share, which goes before although its number is
// lower. Octets that class 2 has got when its turn comes, before it sends 84: 75, 150, 141, 132, 123, 114, 105, 96, 87,
// and then its queue is empty; class 1: 25, 50, 75, 100, 41, 66, 91, 32, 57. So class 2 sends in rounds 2 to 9, class 1
// in rounds 4 and 7, and the rest of class 1 follows.
TEST(EnhancedTransmissionSelection, SharesWhatTheOthersLeave) {
  SharedLink link;
  link.send(2, 8, 1_us);
  link.send(1, 8, 1_us);
  link.send(0, 1, 1_us);
  EXPECT_EQ(link.order(),
            "02221222122"
            "111111");
  EXPECT_EQ(link.order(7),
            "02221222122"
            "111111");
  // One of class 5 comes while the second frame of class 2 is on the medium: it goes next and changes nobody's turn.
  link.send(5, 1, 2'500_ns);
  EXPECT_EQ(link.order(),
            "02252122212"
            "2111111");
}

// A class whose gate is closed has no turn; its share goes to the other one.
TEST(EnhancedTransmissionSelection, BehindAGate) {
  SharedLink link;
  link.config().shaping.gates = GateConfig{
      {{GateOperation::set_gate_states, 0x02, 10_us}, {GateOperation::set_gate_states, 0xFF, 990_us}}, 1_ms, {}, {}};
  link.send(2, 3, 0_us);
  link.send(1, 16, 0_us);
  // The last of 15 frames of class 1 ends after 14 * 672 + 576 ns = 9.984 us, and 15 octets are left of 51 * 25. Class
  // 2 then has 75, 150 and sends, 141 and sends, while class 1 has 40 and 65, and 90 before class 2 has its next turn.
  EXPECT_EQ(link.order(),
            "111111111111111"
            "2212");
}

// Preemptable classes that share: an express frame cuts one of them, and its rest comes before any other.
TEST(EnhancedTransmissionSelection, BesidePreemption) {
  SharedLink link;
  link.config().preemption = PreemptionConfig{0x06, {}, {}, {}};
  const StreamIndex longest = link.builder.stream(link.talker, {link.listener}, {2, 0, Octets{0}});
  link.builder.send_at(longest, 1500_B, {0_us});
  link.send(1, 1, 1_us);
  link.send(7, 1, 5_us);
  EXPECT_EQ(link.order(), "271");
}

}  // namespace
}  // namespace takt::models
