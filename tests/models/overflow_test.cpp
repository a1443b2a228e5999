// SPDX-License-Identifier: Apache-2.0
// Full queues: which frames are lost, why, and what is counted. Minimum frames at 1 Gb/s occupy the medium for 672 ns.
#include <gtest/gtest.h>

#include <vector>

#include "tests/models/network_fixture.hpp"

namespace takt::models::overflow_test {
namespace {

using namespace test;

struct Outcome {
  std::vector<std::uint64_t> arrived;  ///< sequence numbers
  std::uint64_t for_frames = 0;
  std::uint64_t for_octets = 0;
  std::uint64_t counted_by_port = 0;
  std::uint32_t peak = 0;
  std::vector<sim::TraceRecord> drops;
  std::uint64_t digest = 0;
};

/// The digest of a run over the direct link: frames of 64 octets produced at the start; those with these numbers
/// delivered one after the other from 576 ns on, every 672 ns, and then these dropped at the start for that reason.
/// What a record says of a frame that ends is its sequence and when it was produced, which is 0 here.
std::uint64_t digest_of(const std::vector<std::uint64_t>& delivered, const std::vector<std::uint64_t>& dropped,
                        DropReason reason, sim::ComponentId port) {
  sim::Digest digest;
  const std::uint64_t addressing =
      sim::Content(0, 0, 1, 0, 0, 0).value();  // stream 0 from node 0 to node 1; no VLAN, no priority, no tag
  for (std::uint64_t sequence = 0; sequence < delivered.size() + dropped.size(); ++sequence)
    digest.add(3, addressing, at(0_ns), sim::joined(sequence, std::uint64_t{64} << 32 | 0));
  for (std::size_t i = 0; i < delivered.size(); ++i)
    digest.add(1, 1, at(576_ns + 672_ns * static_cast<std::int64_t>(i)),
               sim::joined(delivered[i], 0));  // stream 0 at node 1
  for (const std::uint64_t sequence : dropped)
    digest.add(2, port.index, at(0_ns), sim::joined(sequence, 0) ^ sim::mix64(static_cast<std::uint64_t>(reason) + 1));
  return digest.value();
}

/// Sends frames with these payloads at these times over a direct link whose queues have that limit.
Outcome send(QueueLimit limit, const std::vector<std::pair<Duration, std::size_t>>& frames) {
  Line line(0, 1_Gbps, 0_ns);
  line.builder.plan.port_configs[0].queue_limits.fill(limit);
  const StreamIndex stream = line.builder.stream(line.talker, {line.listener});
  NetworkRun run(line.builder.plan);
  TraceLog trace;
  run.simulation.set_trace(&trace);
  std::vector<Sender::Item> items;
  for (const auto& [time, payload] : frames) items.push_back({local(time), stream, payload});
  install<Sender>(*run.network, line.talker, "sender", items);
  const Listener& listener = listen(*run.network, line.listener, {stream});
  run.until(1_ms);
  Outcome outcome;
  for (const Listener::Arrival& arrival : listener.arrivals) outcome.arrived.push_back(arrival.sequence);
  const Stream& account = run.stream(stream);
  outcome.for_frames = account.dropped[static_cast<std::size_t>(DropReason::queue_frames)];
  outcome.for_octets = account.dropped[static_cast<std::size_t>(DropReason::queue_octets)];
  outcome.counted_by_port = run.port(line.talker, 0).frames_dropped();
  outcome.peak = run.port(line.talker, 0).queues().peak_frames();
  outcome.drops = trace.of(Occurrence::drop);
  outcome.digest = run.digest();
  for (const sim::TraceRecord& drop : outcome.drops) EXPECT_EQ(drop.where, run.port(line.talker, 0).id());
  EXPECT_EQ(account.sent, frames.size());
  EXPECT_EQ(account.dropped_in_all(), outcome.for_frames + outcome.for_octets);
  EXPECT_EQ(account.in_flight(), 0u);
  EXPECT_EQ(run.network->traffic().live_frames(), 0u);
  return outcome;
}

using Sequence = std::vector<std::uint64_t>;
std::vector<std::pair<Duration, std::size_t>> burst(std::size_t count, std::size_t payload) {
  return {count, {0_ns, payload}};
}

// Six frames at once, room for two: the first is sent at once and does not count, the next two wait, three are lost.
TEST(Overflow, ByFrames) {
  const Outcome outcome = send({2, UINT32_MAX}, burst(6, 8));
  EXPECT_EQ(outcome.arrived, (Sequence{0, 1, 2}));
  EXPECT_EQ(outcome.for_frames, 3u);
  EXPECT_EQ(outcome.for_octets, 0u);
  EXPECT_EQ(outcome.counted_by_port, 3u);
  EXPECT_EQ(outcome.peak, 2u);
  ASSERT_EQ(outcome.drops.size(), 3u);
  for (const sim::TraceRecord& drop : outcome.drops) {
    EXPECT_EQ(drop.time, at(0_ns));
    EXPECT_EQ(drop.detail, static_cast<std::uint64_t>(DropReason::queue_frames));
  }
  EXPECT_EQ(outcome.digest, digest_of({0, 1, 2}, {3, 4, 5}, DropReason::queue_frames, outcome.drops[0].where));
}

// Room for 200 octets: three frames of 64 wait (192), the fifth (256) does not fit.
TEST(Overflow, ByOctets) {
  const Outcome outcome = send({UINT32_MAX, 200}, burst(6, 8));
  EXPECT_EQ(outcome.arrived, (Sequence{0, 1, 2, 3}));
  EXPECT_EQ(outcome.for_frames, 0u);
  EXPECT_EQ(outcome.for_octets, 2u);
  EXPECT_EQ(outcome.counted_by_port, 2u);
  EXPECT_EQ(outcome.peak, 3u);
  ASSERT_EQ(outcome.drops.size(), 2u);
  EXPECT_EQ(outcome.digest, digest_of({0, 1, 2, 3}, {4, 5}, DropReason::queue_octets, outcome.drops[0].where));
}

// The limit itself still fits: 192 = 3 * 64; with 191 only two.
TEST(Overflow, ExactlyFull) {
  EXPECT_EQ(send({UINT32_MAX, 192}, burst(6, 8)).arrived, (Sequence{0, 1, 2, 3}));
  EXPECT_EQ(send({UINT32_MAX, 191}, burst(6, 8)).arrived, (Sequence{0, 1, 2}));
}

// 200 octets: 64 + 64 wait, 122 (payload 104) does not fit, 64 does (192), 64 does not.
TEST(Overflow, ASmallerFrameMayStillFit) {
  const Outcome outcome = send({UINT32_MAX, 200}, {{0_ns, 8}, {0_ns, 8}, {0_ns, 8}, {0_ns, 104}, {0_ns, 8}, {0_ns, 8}});
  EXPECT_EQ(outcome.arrived, (Sequence{0, 1, 2, 4}));
  EXPECT_EQ(outcome.for_octets, 2u);
}

// When both limits are hit the number of frames is named.
TEST(Overflow, BothLimits) {
  const Outcome outcome = send({1, 64}, burst(3, 8));
  EXPECT_EQ(outcome.arrived, (Sequence{0, 1}));
  EXPECT_EQ(outcome.for_frames, 1u);
  EXPECT_EQ(outcome.for_octets, 0u);
}

// Room for one. Frame 1 waits behind 0; frame 2 comes at 672 ns, when 1 leaves the queue, and takes its place.
TEST(Overflow, TheFrameThatStartsMakesRoom) {
  EXPECT_EQ(send({1, UINT32_MAX}, {{0_ns, 8}, {100_ns, 8}, {672_ns, 8}}).arrived, (Sequence{0, 1, 2}));
  EXPECT_EQ(send({1, UINT32_MAX}, {{0_ns, 8}, {100_ns, 8}, {671'999_ps, 8}}).arrived, (Sequence{0, 1}));
  EXPECT_EQ(send({1, UINT32_MAX}, {{0_ns, 8}, {100_ns, 8}, {672_ns, 8}, {672_ns, 8}}).arrived, (Sequence{0, 1, 2}));
}

// No room at all: only who finds the medium free is sent.
TEST(Overflow, WithoutAQueue) {
  const Outcome outcome = send({0, UINT32_MAX}, {{0_ns, 8}, {0_ns, 8}, {100_ns, 8}, {672_ns, 8}, {1'344_ns, 8}});
  EXPECT_EQ(outcome.arrived, (Sequence{0, 3, 4}));
  EXPECT_EQ(outcome.for_frames, 2u);
  EXPECT_EQ(outcome.peak, 0u);
}

// Room for two, and the oldest goes: 0 is sent at once, 1 and 2 wait; 3 takes the place of 1, 4 that of 2, 5 that of 3.
TEST(Overflow, TheOldestGoes) {
  const Outcome outcome = send({2, UINT32_MAX, true}, burst(6, 8));
  EXPECT_EQ(outcome.arrived, (Sequence{0, 4, 5}));
  EXPECT_EQ(outcome.for_frames, 3u);
  EXPECT_EQ(outcome.for_octets, 0u);
  EXPECT_EQ(outcome.counted_by_port, 3u);
  EXPECT_EQ(outcome.peak, 2u);
  EXPECT_EQ(outcome.digest, digest_of({0, 4, 5}, {1, 2, 3}, DropReason::queue_frames, outcome.drops[0].where));
}

// Room for 200 octets: 1, 2 and 3 wait (192). The fourth, of 122, has room when 1 and 2 are gone (186); then 64 more
// have when 3 is gone, too. One of 222 octets never has: it is lost itself, and nobody else.
TEST(Overflow, AsManyOfTheOldestAsItTakes) {
  const Outcome outcome =
      send({UINT32_MAX, 200, true}, {{0_ns, 8}, {0_ns, 8}, {0_ns, 8}, {0_ns, 8}, {0_ns, 104}, {0_ns, 8}});
  EXPECT_EQ(outcome.arrived, (Sequence{0, 4, 5}));
  EXPECT_EQ(outcome.for_octets, 3u);
  EXPECT_EQ(send({UINT32_MAX, 200, true}, {{0_ns, 8}, {0_ns, 8}, {0_ns, 204}}).arrived, (Sequence{0, 1}));
  EXPECT_EQ(send({0, UINT32_MAX, true}, burst(2, 8)).arrived, (Sequence{0}));
}

// The gate is open for 2 us of 10. A frame of 1000 octets (8.064 us) never starts; the one that takes its place at 1 us
// (64 octets, 576 ns) does so at once, although the port had been told to ask again at 10 us. At 1.5 us it would not
// have ended: it starts when the next window does.
TEST(Overflow, ANewHeadMayStartAtOnce) {
  const auto arrival = [](Duration second) {
    Line line(0, 1_Gbps, 0_ns);
    PortConfig& config = line.builder.plan.port_configs[0];
    config.queue_limits.fill({1, UINT32_MAX, true});
    config.shaping.gates.emplace();
    config.shaping.gates->admin_control_list = {{GateOperation::set_gate_states, 0xFF, 2_us},
                                                {GateOperation::set_gate_states, 0x00, 8_us}};
    config.shaping.gates->admin_cycle_time = 10_us;
    const StreamIndex stream = line.builder.stream(line.talker, {line.listener});
    NetworkRun run(line.builder.plan);
    install<Sender>(*run.network, line.talker, "sender",
                    std::vector<Sender::Item>{{local(0_ns), stream, 982}, {local(second), stream, 8}});
    const Listener& log = listen(*run.network, line.listener, {stream});
    run.until(1_ms);
    EXPECT_EQ(log.arrivals.size(), 1u);
    EXPECT_EQ(run.stream(stream).dropped[static_cast<std::size_t>(DropReason::queue_frames)], 1u);
    return log.arrivals.empty() ? LocalTime::never() : log.arrivals[0].time;
  };
  EXPECT_EQ(arrival(1_us), local(1'576_ns));
  EXPECT_EQ(arrival(1'424_ns), local(2_us));
  EXPECT_EQ(arrival(1'500_ns), local(10'576_ns));
}

// Each class has its own limit: class 7 holds one frame, class 1 (priority 0) all.
TEST(Overflow, LimitsAreThoseOfTheClass) {
  Line line(0, 1_Gbps, 0_ns);
  line.builder.plan.port_configs[0].queue_limits[7].frames = 1;
  const StreamIndex low = line.builder.stream(line.talker, {line.listener}, {Priority{0}, 0, Octets{0}});
  const StreamIndex high = line.builder.stream(line.talker, {line.listener}, {Priority{7}, 0, Octets{0}});
  line.builder.talk(low, 0_B, BurstSchedule{0_ns, 1_s, 5, 0_ns});
  line.builder.talk(high, 0_B, BurstSchedule{100_ns, 1_s, 5, 0_ns});
  NetworkRun run(line.builder.plan);
  run.until(1_ms);
  EXPECT_EQ(run.stream(low).delivered, 5u);
  EXPECT_EQ(run.stream(high).delivered, 1u);
  EXPECT_EQ(run.stream(high).dropped[static_cast<std::size_t>(DropReason::queue_frames)], 4u);
}

// At a bridge whose egress is ten times slower than its ingress: frames of 64 octets come every 672 ns and leave
// every 6.72 us. Of 30 the first starts at once; 3 wait. A place becomes free every 6.72 us, that is every tenth frame,
// in the instant in which the 11th and 21st come (0, 10, 20 in the count from 0), which therefore fit: 0 1 2 3 10 20
// arrive.
TEST(Overflow, AtABridge) {
  PlanBuilder builder;
  const NodeIndex talker = builder.host("talker");
  const NodeIndex sw = builder.bridge("sw");
  const NodeIndex listener = builder.host("listener");
  builder.link(talker, sw, 1_Gbps);
  builder.link(sw, listener, 100_Mbps);
  PortConfig config;
  config.queue_limits.fill({3, UINT32_MAX});
  builder.plan.nodes[sw.value].port_config = builder.port_config(config);
  const StreamIndex stream = builder.stream(talker, {listener});
  NetworkRun run(builder.plan);
  install<Sender>(*run.network, talker, "sender", std::vector<Sender::Item>(30, {local(0_ns), stream, 8}));
  const Listener& log = listen(*run.network, listener, {stream});
  run.until(1_ms);
  Sequence arrived;
  for (const Listener::Arrival& arrival : log.arrivals) arrived.push_back(arrival.sequence);
  EXPECT_EQ(arrived, (Sequence{0, 1, 2, 3, 10, 20}));
  EXPECT_EQ(run.stream(stream).dropped[static_cast<std::size_t>(DropReason::queue_frames)], 24u);
  EXPECT_EQ(run.port(sw, 1).frames_dropped(), 24u);
  EXPECT_EQ(run.port(sw, 1).queues().peak_frames(), 3u);
}

}  // namespace
}  // namespace takt::models::overflow_test
