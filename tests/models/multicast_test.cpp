// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "tests/models/network_fixture.hpp"

namespace takt::models::multicast_test {
namespace {

using namespace test;

/// talker - sw1 - sw2, one listener at sw1 and two at sw2; 1 Gb/s, 50 ns a cable.
struct Tree {
  Tree() {
    talker = builder.host("talker");
    sw1 = builder.bridge("sw1");
    sw2 = builder.bridge("sw2");
    near = builder.host("near");
    far1 = builder.host("far1");
    far2 = builder.host("far2");
    builder.link(talker, sw1, 1_Gbps, 50_ns);  // sw1 port 0
    builder.link(sw1, sw2, 1_Gbps, 50_ns);     // sw1 port 1, sw2 port 0
    builder.link(sw1, near, 1_Gbps, 50_ns);    // sw1 port 2
    builder.link(sw2, far1, 1_Gbps, 50_ns);    // sw2 port 1
    builder.link(sw2, far2, 1_Gbps, 50_ns);    // sw2 port 2
    stream = builder.stream(talker, {near, far1, far2});
  }
  PlanBuilder builder;
  NodeIndex talker, sw1, sw2, near, far1, far2;
  StreamIndex stream;
};

// 126 octets with preamble: 1058 ns a hop. `near` after two hops, the others after three; one frame on each link, two
// extra copies (one made by each bridge).
TEST(Multicast, OneCopyALink) {
  Tree tree;
  tree.builder.send_at(tree.stream, 100_B, {1_us});
  NetworkRun run(tree.builder.plan);
  run.until(1_ms);
  const Stream& stream = run.stream(tree.stream);
  EXPECT_EQ(stream.sent, 1u);
  EXPECT_EQ(stream.copies, 2u);
  EXPECT_EQ(stream.delivered, 3u);
  EXPECT_EQ(stream.dropped_in_all(), 0u);
  EXPECT_EQ(stream.in_flight(), 0u);
  EXPECT_EQ(stream.listeners, 3u);
  EXPECT_EQ(stream.latency.minimum(), 2'116_ns);
  EXPECT_EQ(stream.latency.maximum(), 3'174_ns);
  EXPECT_EQ(stream.latency.mean(), 2'821'333_ps);  // (2116 + 3174 + 3174) / 3 = 2821.333
  EXPECT_EQ(run.port(tree.talker, 0).frames_sent(), 1u);
  EXPECT_EQ(run.port(tree.sw1, 0).frames_sent(), 0u);
  EXPECT_EQ(run.port(tree.sw1, 1).frames_sent(), 1u);
  EXPECT_EQ(run.port(tree.sw1, 2).frames_sent(), 1u);
  EXPECT_EQ(run.port(tree.sw2, 0).frames_sent(), 0u);
  EXPECT_EQ(run.port(tree.sw2, 1).frames_sent(), 1u);
  EXPECT_EQ(run.port(tree.sw2, 2).frames_sent(), 1u);
  EXPECT_EQ(run.network->traffic().live_frames(), 0u);
}

// The copies share one record: live frames stay 1 while 1, 2, 3, 2 and 0 copies are under way. Production at 1 us; sw1
// has the frame at 2.058, `near` and sw2 at 3.116, the others at 4.174 us.
TEST(Multicast, CopiesShareOneFrame) {
  Tree tree;
  tree.builder.send_at(tree.stream, 100_B, {1_us});
  NetworkRun run(tree.builder.plan);
  struct Row {
    Duration time;
    std::uint64_t in_flight;
    std::size_t live;
    std::uint64_t delivered;
  };
  constexpr Row rows[] = {{999_ns, 0, 0, 0},   {1_us, 1, 1, 0},     {2'057_ns, 1, 1, 0}, {2'058_ns, 2, 1, 0},
                          {3'115_ns, 2, 1, 0}, {3'116_ns, 2, 1, 1}, {4'173_ns, 2, 1, 1}, {4'174_ns, 0, 0, 3}};
  for (const Row& row : rows) {
    run.until(row.time);
    EXPECT_EQ(run.stream(tree.stream).in_flight(), row.in_flight) << row.time.ps();
    EXPECT_EQ(run.network->traffic().live_frames(), row.live) << row.time.ps();
    EXPECT_EQ(run.stream(tree.stream).delivered, row.delivered) << row.time.ps();
  }
}

TEST(Multicast, EveryListenerGetsTheOctets) {
  Tree tree;
  const std::vector<Sender::Item> items = {{local(1_us), tree.stream, 33}, {local(9_us), tree.stream, 44}};
  for (const NodeIndex node : {tree.near, tree.far1, tree.far2}) {
    SCOPED_TRACE(node.value);
    NetworkRun run(tree.builder.plan);
    install<Sender>(*run.network, tree.talker, "sender", items);
    const Listener& listener = listen(*run.network, node, {tree.stream});
    run.until(1_ms);
    ASSERT_EQ(listener.arrivals.size(), 2u);
    EXPECT_EQ(listener.arrivals[0].length, 33u);
    EXPECT_EQ(listener.arrivals[1].length, 44u);
    EXPECT_EQ(listener.arrivals[1].sequence, 1u);
    EXPECT_EQ(run.stream(tree.stream).delivered, 6u);
  }
}

// The queues of sw2 have no room. Two frames: at sw2 the second finds the port to far1 busy and is dropped
// there; the other copies live on.
TEST(Multicast, ADroppedCopyDoesNotHurtTheOthers) {
  Tree tree;
  // far1's link alone is slow, so only it is busy: 126 octets at 100 Mb/s take 10 us.
  tree.builder.plan.links[3].rate = 100_Mbps;
  PortConfig no_room;
  for (QueueLimit& limit : no_room.queue_limits) limit.frames = 0;
  tree.builder.plan.nodes[tree.sw2.value].port_config = tree.builder.port_config(no_room);
  tree.builder.send_at(tree.stream, 100_B, {1_us, 4_us});
  NetworkRun run(tree.builder.plan);
  run.until(1_ms);
  const Stream& stream = run.stream(tree.stream);
  EXPECT_EQ(stream.sent, 2u);
  EXPECT_EQ(stream.copies, 4u);
  EXPECT_EQ(stream.delivered, 5u);
  EXPECT_EQ(stream.dropped[static_cast<std::size_t>(DropReason::queue_frames)], 1u);
  EXPECT_EQ(run.port(tree.sw2, 1).frames_dropped(), 1u);
  EXPECT_EQ(run.port(tree.sw2, 2).frames_dropped(), 0u);
  EXPECT_EQ(run.network->traffic().live_frames(), 0u);
}

}  // namespace
}  // namespace takt::models::multicast_test
