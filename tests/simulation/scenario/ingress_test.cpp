// SPDX-License-Identifier: Apache-2.0
// Policing, ATS and CQF from the scenario to the run.
#include <array>

#include "scenario/resolve/cqf.hpp"
#include "support.hpp"

namespace takt::scenario::test {
namespace {

/// Two talkers and a listener at one switch with that ingress; the streams "one" and "two" to the same listener.
std::string policed(const std::string& ingress, const std::string& more_of_the_switch = {}) {
  return R"({"name": "t", "duration": "10ms", "network": {"nodes": {"a": {"kind": "host"}, "b": {"kind": "host"}, "c": {"kind": "host"},
 "sw": {"kind": "switch", "ingress": {)" +
         ingress + "}" + more_of_the_switch + R"(}},
 "links": [{"ends": ["a", "sw"], "rate": "100Mbps", "delay": "0s"}, {"ends": ["b", "sw"], "rate": "100Mbps", "delay": "0s"},
           {"ends": ["c", "sw"], "rate": "100Mbps", "delay": "0s"}]},
 "streams": [{"name": "one", "from": "a", "to": "c", "payload": "100B", "every": "1ms", "pcp": 3},
             {"name": "two", "from": "b", "to": "c", "payload": "100B", "every": "1ms", "offset": "500us", "pcp": 3}]})";
}

const models::Stream& stream(const LiveRun& run, std::size_t index) { return run.network().traffic().streams()[index]; }
std::uint64_t dropped(const models::Stream& stream, models::DropReason reason) {
  return stream.dropped[static_cast<std::size_t>(reason)];
}

// Both streams go to the same host in the same VLAN. A stream that a filter names gets a group address, so the other
// one does not match.
TEST(Ingress, AFilterNamesOneOfTwoStreamsToTheSameHost) {
  const auto r = sound(policed(R"("filters": [{"stream": "two", "max_sdu": "50B"}])"));
  EXPECT_LT(r->plan.streams[0].destination.value, r->plan.nodes.size());
  EXPECT_GE(r->plan.streams[1].destination.value, r->plan.nodes.size());
  LiveRun run(*r);
  run.advance();
  EXPECT_EQ(stream(run, 0).delivered, 10u);
  EXPECT_EQ(stream(run, 1).delivered, 0u);
  EXPECT_EQ(dropped(stream(run, 1), models::DropReason::stream_max_sdu), 10u);
}

// 150 octets from DA to FCS; 600 kb/s bring 75 octets a millisecond: every other frame after the burst of two.
TEST(Ingress, AMeterLimitsByPriority) {
  const auto r = sound(policed(
      R"("filters": [{"pcp": 3, "stream": "one", "meter": "m"}], "meters": [{"name": "m", "cir": "600kbps", "cbs": "300B"}])"));
  LiveRun run(*r);
  run.advance();
  // Frames 0 to 9; after 0, 1 and 2 (300 octets at the start, 75 more each time) 4, 6 and 8 find 150 octets again.
  EXPECT_EQ(stream(run, 0).delivered, 6u);
  EXPECT_EQ(dropped(stream(run, 0), models::DropReason::flow_meter), 4u);
  EXPECT_EQ(stream(run, 1).delivered, 10u);
}

TEST(Ingress, AnExplicitEntryIdentifiesBySource) {
  const auto r = sound(
      policed(R"("streams": [{"name": "from-b", "source": "b"}], "filters": [{"stream": "from-b", "gate": "shut"}],
 "gates": [{"name": "shut", "open": false}])"));
  LiveRun run(*r);
  run.advance();
  EXPECT_EQ(stream(run, 0).delivered, 10u);
  EXPECT_EQ(dropped(stream(run, 1), models::DropReason::stream_gate), 10u);
}

TEST(Ingress, AnExplicitEntryIdentifiesByMask) {
  // Node b is the second one: 02-00-5E-00-00-01.
  const auto r = sound(policed(
      R"("streams": [{"name": "b", "mask": {"source": "02-00-5E-00-00-01", "source_mask": "FF:FF:FF:FF:FF:FF"}}],
 "filters": [{"stream": "b", "gate": "shut"}], "gates": [{"name": "shut", "open": false}])"));
  LiveRun run(*r);
  run.advance();
  EXPECT_EQ(stream(run, 0).delivered, 10u);
  EXPECT_EQ(stream(run, 1).delivered, 0u);
}

// Stream "two" comes 500 us after a millisecond begins, when the gate is closed.
TEST(Ingress, AStreamGateKeepsItsSchedule) {
  const auto r = sound(policed(
      R"("filters": [{"pcp": 3, "gate": "g"}], "gates": [{"name": "g", "entries": [{"open": true, "for": "100us"}, {"open": false, "for": "900us"}]}])"));
  LiveRun run(*r);
  run.advance();
  EXPECT_EQ(stream(run, 0).delivered, 10u);
  EXPECT_EQ(dropped(stream(run, 1), models::DropReason::stream_gate), 10u);
}

// A long frame leaves the switch from 116.64 us to 233.28 us (1450 octets and preamble, twice), the next may start 0.96
// us later. The frames of "one" and "two", produced at 150 and 165 us, wait for it. Lifted to priority 7, "two" goes
// first.
TEST(Ingress, AnInternalPriorityDecidesAboutTheQueue) {
  const auto latencies = [](const std::string& ingress) {
    std::string text = policed(ingress);
    const auto replace = [&](const std::string& from, const std::string& to) {
      text.replace(text.find(from), from.size(), to);
    };
    replace(R"("every": "1ms", "pcp": 3})", R"("every": "1ms", "offset": "150us", "pcp": 3})");
    replace(R"("name": "two", "from": "b")", R"("name": "two", "from": "a")");
    replace(
        R"("offset": "500us", "pcp": 3})",
        R"("offset": "165us", "pcp": 3}, {"name": "long", "from": "b", "to": "c", "payload": "1400B", "every": "1ms", "pcp": 0})");
    const auto r = sound(text);
    LiveRun run(*r);
    run.advance();
    return std::array{stream(run, 0).latency.maximum(), stream(run, 1).latency.maximum()};
  };
  EXPECT_EQ(latencies(""), (std::array{Duration::from_ps(96'880'000), Duration::from_ps(95'480'000)}));
  EXPECT_EQ(latencies(R"("filters": [{"stream": "two", "gate": "lift"}], "gates": [{"name": "lift", "ipv": 7}])"),
            (std::array{Duration::from_ps(110'480'000), Duration::from_ps(81'880'000)}));
}

TEST(Ingress, AtsIsValidatedByItsScenario) {
  const auto r = shipped("validation/ats", "3ms");
  LiveRun run(*r);
  run.advance();
  EXPECT_EQ(stream(run, 0).latency.minimum(), Duration::from_ps(25'280'000));
  EXPECT_EQ(stream(run, 0).latency.maximum(), Duration::from_ps(161'280'000));
}

const ClassOfPriority identity = models::identity_traffic_classes;

TEST(Cqf, TwoBuffersAreSwapped) {
  Cqf cqf;
  cqf.cycle = 100_us;
  cqf.classes = {6, 5};
  const CqfTimes times{1_us, {}};
  const models::StreamGateConfig gate = cqf_stream_gate(cqf, times, identity);
  ASSERT_EQ(gate.admin_control_list.size(), 2u);
  EXPECT_EQ(gate.admin_control_list[0].ipv, 6);
  EXPECT_EQ(gate.admin_control_list[1].ipv, 5);
  EXPECT_EQ(gate.admin_cycle_time, 200_us);
  const models::GateConfig gates = cqf_port_gates(cqf, times);
  ASSERT_EQ(gates.admin_control_list.size(), 4u);
  const auto states = [&](std::size_t i) { return int{gates.admin_control_list[i].gate_states}; };
  EXPECT_EQ(states(0), 0b1011'1111);  // 6 is filled, 5 is sent
  EXPECT_EQ(states(1), 0b1001'1111);
  EXPECT_EQ(states(2), 0b1101'1111);
  EXPECT_EQ(states(3), 0b1001'1111);
  EXPECT_EQ(gates.admin_control_list[0].interval, 99_us);
  EXPECT_EQ(gates.admin_control_list[1].interval, 1_us);
}

TEST(Cqf, WithThreeBuffersReceivingLags) {
  Cqf cqf;
  cqf.cycle = 100_us;
  cqf.classes = {4, 5, 6};
  cqf.base_time = 7_us;
  const CqfTimes times{{}, 30_us};
  EXPECT_EQ(cqf_stream_gate(cqf, times, identity).admin_base_time, sim::LocalTime() + 37_us);
  const models::GateConfig gates = cqf_port_gates(cqf, times);
  EXPECT_EQ(gates.admin_base_time, sim::LocalTime() + 7_us);
  ASSERT_EQ(gates.admin_control_list.size(), 3u);
  EXPECT_EQ(int{gates.admin_control_list[0].gate_states},
            0b1010'1111);  // while 4 is filled 5 is sent, filled two cycles ago
}

// Over h switches between (h - 1) T and (h + 1) T, plus the two outer links; nothing is lost beside heavy traffic of
// lower priority.
TEST(Cqf, LatencyStaysWithinItsCycles) {
  const auto r = shipped("tsn/cqf", "200ms");
  LiveRun run(*r);
  run.advance();
  const models::Stream& axis = stream(run, 0);
  EXPECT_EQ(axis.dropped_in_all(), 0u);
  EXPECT_GE(axis.latency.minimum(), 500_us);
  EXPECT_LE(axis.latency.maximum(), 1'030_us);
}

TEST(Cqf, ThreeBuffersBearLongCables) {
  const auto r = shipped("tsn/cqf-three-buffers", "200ms");
  LiveRun run(*r);
  run.advance();
  EXPECT_EQ(stream(run, 0).dropped_in_all(), 0u);
  // Every cycle's frames move together: whatever the arrival within the cycle of 100 us, jitter is at most two cycles.
  EXPECT_LE(stream(run, 0).latency.maximum() - stream(run, 0).latency.minimum(), 200_us);
}

// Results do not depend on the order within an instant.
TEST(Ingress, TheTieShuffleChangesNothing) {
  for (const char* const name : {"tsn/policing", "tsn/ats", "tsn/cqf", "tsn/cqf-three-buffers", "tsn/frer-ring",
                                 "tsn/frer-hosts", "validation/frer"}) {
    const auto r = shipped(name, "50ms");
    const std::uint64_t digest = digest_of(*r);
    EXPECT_EQ(digest_of(*r, 1), digest) << name;
    EXPECT_EQ(digest_of(*r, 0x9E37'79B9), digest) << name;
  }
}

}  // namespace
}  // namespace takt::scenario::test
