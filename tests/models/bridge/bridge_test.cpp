// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "tests/models/network_fixture.hpp"

namespace takt::models::bridge_test {
namespace {

using namespace test;

constexpr auto no_entry = static_cast<std::size_t>(DropReason::no_filtering_entry);

/// Three hosts at ports 0, 1, 2 of a bridge; one frame from the first to the second. Filtering entries as the test
/// wants them.
struct Star {
  Star() {
    for (NodeIndex& node : hosts) node = builder.host("host" + std::to_string(&node - hosts));
    sw = builder.bridge("sw");
    for (const NodeIndex node : hosts) builder.link(node, sw);
    stream = builder.stream(hosts[0], {hosts[1]}, {Priority{2}, 5, Octets{0}});
    builder.send_at(stream, 100_B, {1_us});
    builder.plan.filtering.clear();
  }
  void entry(VlanId vlan, NodeIndex address, std::uint16_t port) {
    builder.plan.filtering.push_back({sw, vlan, AddressIndex{address.value}, port});
  }
  struct Account {
    std::uint64_t sent, copies, delivered;
    decltype(Stream::dropped) dropped;
  };
  Account run() {
    NetworkRun once(builder.plan);
    once.simulation.set_trace(&trace);
    once.until(1_ms);
    for (std::size_t port = 0; port < 3; ++port) sent[port] = once.port(sw, port).frames_sent();
    bridge_id = once.network->bridge(sw).id();
    EXPECT_EQ(once.network->traffic().live_frames(), 0u);
    const Stream& account = once.stream(stream);
    return {account.sent, account.copies, account.delivered, account.dropped};
  }
  PlanBuilder builder;
  NodeIndex hosts[3];
  NodeIndex sw;
  StreamIndex stream;
  TraceLog trace;
  std::uint64_t sent[3] = {};
  sim::ComponentId bridge_id;
};

TEST(Bridge, ForwardsToTheEntrysPort) {
  Star star;
  star.entry(5, star.hosts[1], 1);
  const Star::Account account = star.run();
  EXPECT_EQ(account.delivered, 1u);
  EXPECT_EQ(account.copies, 0u);
  EXPECT_EQ(star.sent[1], 1u);
}

// 1 us + 130 * 8 ns (122 octets tagged and preamble) = 2.04 us.
TEST(Bridge, DropsAnUnknownAddress) {
  Star star;
  const Star::Account account = star.run();
  EXPECT_EQ(account.sent, 1u);
  EXPECT_EQ(account.delivered, 0u);
  EXPECT_EQ(account.dropped[no_entry], 1u);
  const std::vector<sim::TraceRecord> drops = star.trace.of(Occurrence::drop);
  ASSERT_EQ(drops.size(), 1u);
  EXPECT_EQ(drops[0].time, at(2'040_ns));
  EXPECT_EQ(drops[0].where, star.bridge_id);
  EXPECT_EQ(drops[0].detail, no_entry);
}

TEST(Bridge, AnotherVlanIsAnotherEntry) {
  Star star;
  star.entry(6, star.hosts[1], 1);
  EXPECT_EQ(star.run().dropped[no_entry], 1u);
}

TEST(Bridge, NeverSendsBackThroughTheIngressPort) {
  Star star;
  star.entry(5, star.hosts[1], 0);  // the only port is the ingress
  const Star::Account account = star.run();
  EXPECT_EQ(account.dropped[no_entry], 1u);
  EXPECT_EQ(star.sent[0], 0u);
}

TEST(Bridge, LeavesTheIngressPortOutOfASet) {
  Star star;
  star.entry(5, star.hosts[1], 0);
  star.entry(5, star.hosts[1], 1);
  const Star::Account account = star.run();
  EXPECT_EQ(account.delivered, 1u);
  EXPECT_EQ(account.copies, 0u);
  EXPECT_EQ(star.sent[0], 0u);
}

// Both other ports: two frames, of which the one that reaches a host that does not listen is dropped there.
TEST(Bridge, AHostThatDoesNotListenDrops) {
  Star star;
  for (const std::uint16_t port : std::initializer_list<std::uint16_t>{0, 1, 2, 1}) star.entry(5, star.hosts[1], port);
  const Star::Account account = star.run();
  EXPECT_EQ(account.copies, 1u);
  EXPECT_EQ(account.delivered, 1u);
  EXPECT_EQ(account.dropped[no_entry], 1u);
  EXPECT_EQ(star.sent[0], 0u);
  EXPECT_EQ(star.sent[1], 1u);
  EXPECT_EQ(star.sent[2], 1u);
}

TEST(Bridge, AnEntryForAPortThatDoesNotExistIsACheck) {
  Star star;
  star.entry(5, star.hosts[1], 1);
  star.entry(5, star.hosts[1], 7);
  EXPECT_THROW(star.run(), sim::InvariantBroken);
}

// A listener knows streams by number, also among many.
TEST(Host, FindsItsStreamAmongMany) {
  PlanBuilder builder;
  const NodeIndex talker = builder.host("talker");
  const NodeIndex listener = builder.host("listener");
  builder.link(talker, listener);
  std::vector<StreamIndex> streams;
  for (int i = 0; i < 9; ++i) {
    streams.push_back(builder.stream(talker, {listener}));
    builder.send_at(streams.back(), 50_B, {10_us * i});
  }
  builder.plan.streams[4].listeners.clear();
  NetworkRun run(builder.plan);
  run.until(1_ms);
  for (std::size_t i = 0; i < 9; ++i) {
    EXPECT_EQ(run.stream(streams[i]).delivered, i == 4 ? 0u : 1u) << i;
    EXPECT_EQ(run.stream(streams[i]).dropped[no_entry], i == 4 ? 1u : 0u) << i;
  }
}

TEST(DropReason, EachHasAName) {
  for (std::size_t i = 0; i < static_cast<std::size_t>(DropReason::count); ++i)
    EXPECT_STRNE(name_of(static_cast<DropReason>(i)), "?");
}

}  // namespace
}  // namespace takt::models::bridge_test
