// SPDX-License-Identifier: Apache-2.0
// One port by hand. 100 Mb/s: an octet lasts 80 ns. Frames of 1518 octets occupy 1538 octets, 123.04 us, and their last
// bit is out after 1526, 122.08 us; frames of 64 octets 84, 6.72 us, and 72, 5.76 us.
#include "analysis/port_bound.hpp"

#include <gtest/gtest.h>

#include "analysis/gate_windows.hpp"

namespace takt::analysis::port_bound_test {
namespace {

constexpr Ps octet = 80'000;
constexpr Ps ns = 1'000;
constexpr Ps us = 1'000'000;

PortFlow flow(std::uint32_t octets, models::TrafficClass q, Ps period, Ps jitter = 0, std::size_t link = 0) {
  PortFlow made;
  made.arrivals = FrameArrivals({period, 1, 0, jitter});
  made.frame = sim::Octets{octets};
  made.lowest_class = made.highest_class = q;
  made.link = link;
  return made;
}

struct Port {
  models::PortConfig config;
  PortTraffic traffic{{{}}, {}};
  PortBound bound() const {
    PortModel model;
    model.octet_time = octet;
    model.config = &config;
    return bound_port(model, traffic);
  }
};

TEST(PortBound, StrictPriority) {
  Port port;
  port.traffic.flows = {flow(64, 7, 1000 * us), flow(64, 7, 1000 * us), flow(1518, 0, 1000 * us),
                        flow(1518, 3, 1000 * us)};
  const PortBound bound = port.bound();
  // Behind one long frame and the other short one.
  EXPECT_EQ(bound.flows[0].delay, 123'040 * ns + 6'720 * ns + 5'760 * ns);
  EXPECT_EQ(bound.flows[0].least_delay, 5'760 * ns);
  // Behind all that is higher; nothing is lower.
  EXPECT_EQ(bound.flows[2].delay, 2 * 6'720 * ns + 123'040 * ns + 122'080 * ns);
  EXPECT_EQ(bound.flows[3].delay, 123'040 * ns + 2 * 6'720 * ns + 122'080 * ns);
  EXPECT_EQ(bound.classes[7].backlog, 2 * 6'720 * ns);
  EXPECT_EQ(bound.classes[7].backlog_frames, 2);
}

// Two flows by one link of the same rate: the second of their frames comes 6.72 us after the first at the earliest,
// when that is sent already.
TEST(PortBound, LineShaping) {
  Port port;
  port.traffic.links.push_back({octet, false});
  port.traffic.flows = {flow(64, 7, 1000 * us, 0, 1), flow(64, 7, 1000 * us, 0, 1)};
  EXPECT_EQ(port.bound().flows[0].delay, 5'760 * ns);
  port.traffic.links[1].is_mixed = true;
  EXPECT_EQ(port.bound().flows[0].delay, 6'720 * ns + 5'760 * ns);
}

// An express frame waits for 143 octets of a preemptable one, 11.44 us. The preemptable frame is cut once: 24
// octets, 1.92 us.
TEST(PortBound, Preemption) {
  Port port;
  port.config.preemption = models::PreemptionConfig{models::with(0, 0), {}, {}, {}};
  port.traffic.flows = {flow(64, 7, 1000 * us), flow(1518, 0, 1000 * us)};
  const PortBound bound = port.bound();
  EXPECT_EQ(bound.flows[0].delay, 11'440 * ns + 5'760 * ns);
  EXPECT_EQ(bound.flows[1].delay, 122'080 * ns + 6'720 * ns + 1'920 * ns);
}

// Class 7 has the first 100 us of each ms. Of its window 5.76 us at the end are too short for a frame, and 0.96 us at
// the start the gap behind one of class 0. It comes when it just does not fit any more: 905.76 us and the gap until it
// can start, and the gap of a frame of class 0 once more for the busy period.
models::GateConfig one_in_ten() {
  models::GateConfig gates;
  gates.admin_control_list = {{models::GateOperation::set_gate_states, 0x80, sim::Duration::from_ps(100 * us)},
                              {models::GateOperation::set_gate_states, 0x7F, sim::Duration::from_ps(900 * us)}};
  gates.admin_cycle_time = sim::Duration::from_ps(1000 * us);
  return gates;
}

TEST(PortBound, Gates) {
  Port port;
  port.config.shaping.gates = one_in_ten();
  port.traffic.flows = {flow(64, 7, 1000 * us), flow(1518, 0, 2000 * us)};
  EXPECT_EQ(port.bound().flows[0].delay, 905'760 * ns + 2 * 960 * ns + 5'760 * ns);
  // At a known phase within the window it waits for nothing at all: the gate of class 0 has been closed for long.
  port.traffic.flows[0].phase = ArrivalPhase{20 * us, 1000 * us, 3 * us};
  EXPECT_EQ(port.bound().flows[0].delay, 5'760 * ns);
  // One that reaches beyond the last possible start may just miss it.
  port.traffic.flows[0].phase = ArrivalPhase{90 * us, 1000 * us, 8 * us};
  EXPECT_GT(port.bound().flows[0].delay, 905'760 * ns);
  EXPECT_LE(port.bound().flows[0].delay, 905'760 * ns + 2 * 960 * ns + 5'760 * ns);
}

TEST(PortBound, OverloadAndRandomGapsAreUnbounded) {
  Port port;
  port.traffic.flows = {flow(1518, 3, 100 * us), flow(64, 7, 1000 * us)};
  EXPECT_FALSE(is_bounded(port.bound().flows[0].delay));
  EXPECT_FALSE(port.bound().classes[3].reason.empty());
  EXPECT_EQ(port.bound().flows[1].delay, 123'040 * ns + 5'760 * ns);  // the higher class does not suffer
  port.traffic.flows[1].arrivals = FrameArrivals();
  EXPECT_FALSE(is_bounded(port.bound().flows[1].delay));
}

// Three frames of 123.04 us in windows of 370 us each ms, at any time. The third one, 246.08 us later, ends after
// 368.16 us; the gap of the last one of the window before is long over. A frame comes when it does not fit any more,
// 122.08 us before the end: it waits 1000 - (370 - 122.08) us, and for the two others. That the window is taken for as
// long as no frame is missed is the point: less the longest frame it holds two of three.
TEST(PortBound, AWindowHoldsWholeFrames) {
  Port port;
  models::GateConfig gates;
  gates.admin_control_list = {{models::GateOperation::set_gate_states, 0x80, sim::Duration::from_ps(370 * us)},
                              {models::GateOperation::set_gate_states, 0x7F, sim::Duration::from_ps(630 * us)}};
  gates.admin_cycle_time = sim::Duration::from_ps(1000 * us);
  port.config.shaping.gates = gates;
  port.traffic.flows = {flow(1518, 7, 1000 * us), flow(1518, 7, 1000 * us), flow(1518, 7, 1000 * us)};
  EXPECT_EQ(port.bound().flows[0].delay, 752'080 * ns + 2 * 123'040 * ns + 122'080 * ns);
  // A fourth one does not fit.
  port.traffic.flows = {flow(1518, 7, 1000 * us), flow(1518, 7, 1000 * us), flow(1518, 7, 1000 * us),
                        flow(1518, 7, 1000 * us)};
  EXPECT_FALSE(is_bounded(port.bound().flows[0].delay));
}

// A window as long as its frame, 122.08 us: one that just misses it has the next one, a cycle later. The gap behind
// its own frame of the window before is over; that of another class which closes as the window opens is not, and takes
// the window away. Where nobody may send for a gap before, it does not; once it counts as something that goes before.
TEST(PortBound, AWindowOfOneFrame) {
  const auto entry = [](std::uint8_t open, std::int64_t length) {
    return models::GateControlEntry{models::GateOperation::set_gate_states, open, sim::Duration::from_ps(length)};
  };
  Port port;
  models::GateConfig gates;
  gates.admin_control_list = {entry(0x80, 122'080 * ns), entry(0x7F, 877'920 * ns)};
  gates.admin_cycle_time = sim::Duration::from_ps(1000 * us);
  port.config.shaping.gates = gates;
  port.traffic.flows = {flow(1518, 7, 1000 * us)};
  EXPECT_EQ(port.bound().flows[0].delay, 1000 * us + 122'080 * ns);
  port.traffic.flows.push_back(flow(64, 3, 1000 * us));
  EXPECT_FALSE(is_bounded(port.bound().flows[0].delay));
  gates.admin_control_list = {entry(0x80, 122'080 * ns), entry(0x7F, 876'960 * ns), entry(0, 960 * ns)};
  port.config.shaping.gates = gates;
  EXPECT_EQ(port.bound().flows[0].delay, 2000 * us + 122'080 * ns);
}

// What happens once never repeats: ten frames 100 us apart, of which each waits for those before it. The last one comes
// after 900 us, when nine have come, and starts after nine.
TEST(PortBound, WhatHappensOnceIsLookedAtToItsEnd) {
  Port port;
  port.traffic.flows = {flow(1518, 7, 1000 * us)};
  port.traffic.flows[0].arrivals = FrameArrivals({unbounded_ps, 10, 100 * us, 0});
  EXPECT_EQ(port.bound().flows[0].delay, 9 * 123'040 * ns + 122'080 * ns - 900 * us);
}

// More comes than is sent, but the queue has room for four frames: three of them and one on the medium go before, and
// one of class 7.
TEST(PortBound, AFullQueueLimitsTheDelay) {
  Port port;
  port.traffic.flows = {flow(1518, 3, 100 * us), flow(64, 7, 1000 * us)};
  port.config.queue_limits[3].frames = 4;
  EXPECT_EQ(port.bound().flows[0].delay, 4 * 123'040 * ns + 6'720 * ns + 122'080 * ns);
  EXPECT_GT(port.bound().classes[3].backlog_frames, 4);  // some are dropped
  // 3,200 octets are room for two frames, and one of them is the one that comes: 3,200 octets and the preamble and gap
  // of one make 257.6 us, a frame 123.04 us, of which the lesser counts.
  port.config.queue_limits[3] = {0xFFFF'FFFF, 3'200};
  EXPECT_EQ(port.bound().flows[0].delay, 2 * 123'040 * ns + 6'720 * ns + 122'080 * ns);
  // Whatever comes.
  port.traffic.flows[0].arrivals = FrameArrivals();
  EXPECT_EQ(port.bound().flows[0].delay, 2 * 123'040 * ns + 6'720 * ns + 122'080 * ns);
  // Without room for more than what comes anyway, the limit changes nothing.
  port.traffic.flows = {flow(1518, 3, 1000 * us), flow(64, 7, 1000 * us)};
  EXPECT_EQ(port.bound().flows[0].delay, 6'720 * ns + 122'080 * ns);
  EXPECT_EQ(port.bound().classes[3].backlog_frames, 1);
}

// A class with a fifth of the link waits for one frame of a lower class and one of a higher one, 246.08 us, and no
// longer: the next higher one comes 1 ms later. Whatever credit it has got from that serves frames that come later; it
// does not make one wait.
TEST(PortBound, ACreditBasedShaperWaitsWithCreditForSoLong) {
  Port port;
  port.config.shaping.selection[6] = models::CreditBased{sim::DataRate{20'000'000}, true};
  port.traffic.flows = {flow(64, 6, 1000 * us), flow(1518, 7, 1000 * us), flow(1518, 0, 1000 * us)};
  const Ps exact = 2 * 123'040 * ns + 5'760 * ns;
  EXPECT_GE(port.bound().flows[0].delay, exact);
  EXPECT_LE(port.bound().flows[0].delay, exact + 20);
  // Three frames at once, nothing else there: the third one starts when its two predecessors have been paid for, 2
  // * 6.72 / 0.2.
  port.traffic.flows = {flow(64, 6, 10'000 * us), flow(64, 6, 10'000 * us), flow(64, 6, 10'000 * us)};
  EXPECT_GE(port.bound().flows[0].delay, 67'200 * ns + 5'760 * ns);
  EXPECT_LE(port.bound().flows[0].delay, 67'200 * ns + 5'760 * ns + 20);
}

// Class 2 and class 1 have half each. The short frame waits for the long one, which may go before it; the long one for
// one short one.
TEST(PortBound, ClassesThatShareWaitForEachOther) {
  Port port;
  port.config.shaping.selection[2] = models::EnhancedTransmissionSelection{50};
  port.config.shaping.selection[1] = models::EnhancedTransmissionSelection{50};
  port.traffic.flows = {flow(64, 2, 1000 * us), flow(1518, 1, 1000 * us)};
  EXPECT_EQ(port.bound().flows[0].delay, 123'040 * ns + 5'760 * ns);
  EXPECT_EQ(port.bound().flows[1].delay, 6'720 * ns + 122'080 * ns);
  // All other classes go before both, even the lowest; they wait for one frame at most.
  port.traffic.flows.push_back(flow(1518, 0, 1000 * us));
  EXPECT_EQ(port.bound().flows[0].delay, 2 * 123'040 * ns + 5'760 * ns);
  EXPECT_EQ(port.bound().flows[2].delay, 123'040 * ns + 122'080 * ns);
}

// More comes to class 1 than the link carries. Class 2 keeps its share: 84 octets need two rounds of 50, in which class
// 1 is given 100, beside up to 1,537 that it may have left; and a frame of 1,538 octets may be under way.
TEST(PortBound, AClassKeepsItsShare) {
  Port port;
  port.config.shaping.selection[2] = models::EnhancedTransmissionSelection{50};
  port.config.shaping.selection[1] = models::EnhancedTransmissionSelection{50};
  port.traffic.flows = {flow(64, 2, 1000 * us), flow(1518, 1, 100 * us)};
  const PortBound bound = port.bound();
  EXPECT_EQ(bound.flows[0].delay, 123'040 * ns + (100 + 1'537) * octet + 5'760 * ns);
  EXPECT_FALSE(is_bounded(bound.flows[1].delay));
  EXPECT_FALSE(bound.classes[1].reason.empty());
  // With nine tenths it needs one round, in which class 1 is given 10.
  port.config.shaping.selection[2] = models::EnhancedTransmissionSelection{90};
  port.config.shaping.selection[1] = models::EnhancedTransmissionSelection{10};
  EXPECT_EQ(port.bound().flows[0].delay, 123'040 * ns + (10 + 1'537) * octet + 5'760 * ns);
  // No more than its share: 64 octets every 10 us are two thirds of the link, and half of it is its own.
  port.config.shaping.selection[2] = models::EnhancedTransmissionSelection{50};
  port.traffic.flows[0] = flow(64, 2, 10 * us);
  port.config.shaping.selection[1] = models::EnhancedTransmissionSelection{50};
  EXPECT_FALSE(is_bounded(port.bound().flows[0].delay));
}

// Turns behind gates have no bound, and say so.
TEST(PortBound, SharesBehindGates) {
  Port port;
  port.config.shaping.selection[1] = models::EnhancedTransmissionSelection{50};
  port.config.shaping.selection[0] = models::EnhancedTransmissionSelection{50};
  port.config.shaping.gates = one_in_ten();
  port.traffic.flows = {flow(64, 7, 1000 * us), flow(64, 1, 1000 * us), flow(1518, 0, 2000 * us)};
  const PortBound bound = port.bound();
  EXPECT_EQ(bound.flows[0].delay, 905'760 * ns + 2 * 960 * ns + 5'760 * ns);
  EXPECT_FALSE(is_bounded(bound.flows[1].delay));
  EXPECT_EQ(bound.classes[1].reason, "classes that share bandwidth (ETS) behind gates");
}

TEST(GateWindows, TheWorstPhase) {
  const GateCycle gates(one_in_ten());
  const PeriodicSupply supply(gates, 7, std::vector<Ps>(gates.windows(7).size(), 0), 0, 10 * us, 0, 0);
  EXPECT_EQ(supply.time_for(0), 910 * us);
  EXPECT_EQ(supply.time_for(90 * us), 1000 * us);
  EXPECT_EQ(supply.time_for(91 * us), 1000 * us + 911 * us);
  const PhasedSupply phased(gates, 7, 0, std::vector<Ps>(gates.windows(7).size(), 0), 0, 10 * us);
  EXPECT_EQ(phased.time_from(5 * us, 20 * us), 20 * us);
  EXPECT_EQ(phased.time_from(90 * us, 0), 0);
  EXPECT_EQ(phased.time_from(91 * us, 0), 909 * us);
  EXPECT_EQ(phased.time_from(-1 * us, 91 * us), 1 * us + 1000 * us + 1 * us);
  EXPECT_FALSE(
      is_bounded(PeriodicSupply(gates, 7, std::vector<Ps>(gates.windows(7).size(), 0), 0, 101 * us, 0, 0).time_for(1)));
  EXPECT_TRUE(gates.overlap(3, 0));
  EXPECT_FALSE(gates.overlap(7, 0));
}

// Frames of 1000 bits through a bucket of 2500 bits and 1 Mb/s: two at once, then one each ms.
TEST(TokenBucket, AsArrivalCurve) {
  const ArrivalPattern bucket = pattern_of_token_bucket(1000, 2500, 1'000'000);
  EXPECT_EQ(bucket.count(0), 2);
  EXPECT_EQ(bucket.count(500 * us - 1), 2);
  EXPECT_EQ(bucket.count(500 * us), 3);
  EXPECT_EQ(bucket.count(1500 * us), 4);
  EXPECT_TRUE(conforms(FrameArrivals({1000 * us, 1, 0, 0}), 1000, 2500, 1'000'000));
  EXPECT_FALSE(conforms(FrameArrivals({3000 * us, 3, 0, 0}), 1000, 2500, 1'000'000));
  EXPECT_EQ(longest_hold(FrameArrivals({3000 * us, 3, 0, 0}), 1000, 2500, 1'000'000), 500 * us);
  EXPECT_FALSE(is_bounded(longest_hold(FrameArrivals({2000 * us, 3, 0, 0}), 1000, 2500, 1'000'000)));
}

}  // namespace
}  // namespace takt::analysis::port_bound_test
