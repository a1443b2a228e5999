// One port by hand. 100 Mb/s: an octet lasts 80 ns. Frames of 1518 octets occupy 1538 octets, 123.04 us, and their last bit is out after 1526, 122.08 us; frames of 64 octets
// 84, 6.72 us, and 72, 5.76 us.
#include "analysis/port_bound.hpp"

#include <gtest/gtest.h>

#include "analysis/gate_windows.hpp"

namespace takt::analysis {
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
  port.traffic.flows = {flow(64, 7, 1000 * us), flow(64, 7, 1000 * us), flow(1518, 0, 1000 * us), flow(1518, 3, 1000 * us)};
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

// Two flows by one link of the same rate: the second of their frames comes 6.72 us after the first at the earliest, when that is sent already.
TEST(PortBound, LineShaping) {
  Port port;
  port.traffic.links.push_back({octet, false});
  port.traffic.flows = {flow(64, 7, 1000 * us, 0, 1), flow(64, 7, 1000 * us, 0, 1)};
  EXPECT_EQ(port.bound().flows[0].delay, 5'760 * ns);
  port.traffic.links[1].is_mixed = true;
  EXPECT_EQ(port.bound().flows[0].delay, 6'720 * ns + 5'760 * ns);
}

// An express frame waits for 143 octets of a preemptable one, 11.44 us. The preemptable frame is cut once: 24 octets, 1.92 us.
TEST(PortBound, Preemption) {
  Port port;
  port.config.preemption = models::PreemptionConfig{models::with(0, 0), {}, {}, {}};
  port.traffic.flows = {flow(64, 7, 1000 * us), flow(1518, 0, 1000 * us)};
  const PortBound bound = port.bound();
  EXPECT_EQ(bound.flows[0].delay, 11'440 * ns + 5'760 * ns);
  EXPECT_EQ(bound.flows[1].delay, 122'080 * ns + 6'720 * ns + 1'920 * ns);
}

// Class 7 has the first 100 us of each ms. Of its window 5.76 us at the end are too short for a frame, and 0.96 us at the start the gap behind one of class 0. It comes when it
// just does not fit any more: 905.76 us and the gap until it can start, and the gap of a frame of class 0 once more for the busy period.
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
  EXPECT_EQ(port.bound().flows[1].delay, 123'040 * ns + 5'760 * ns);   // the higher class does not suffer
  port.traffic.flows[1].arrivals = FrameArrivals();
  EXPECT_FALSE(is_bounded(port.bound().flows[1].delay));
}

TEST(GateWindows, TheWorstPhase) {
  const GateCycle gates(one_in_ten());
  const PeriodicSupply supply(gates, 7, 0, 10 * us, 0);
  EXPECT_EQ(supply.time_for(0), 910 * us);
  EXPECT_EQ(supply.time_for(90 * us), 1000 * us);
  EXPECT_EQ(supply.time_for(91 * us), 1000 * us + 911 * us);
  const PhasedSupply phased(gates, 7, 0, 0, 10 * us);
  EXPECT_EQ(phased.time_from(5 * us, 20 * us), 20 * us);
  EXPECT_EQ(phased.time_from(90 * us, 0), 0);
  EXPECT_EQ(phased.time_from(91 * us, 0), 909 * us);
  EXPECT_EQ(phased.time_from(-1 * us, 91 * us), 1 * us + 1000 * us + 1 * us);
  EXPECT_FALSE(is_bounded(PeriodicSupply(gates, 7, 0, 101 * us, 0).time_for(1)));
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
}  // namespace takt::analysis
