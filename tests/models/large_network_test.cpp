// SPDX-License-Identifier: Apache-2.0
// From 2048 components on the loop looks ahead (Component::prefetch). That must change nothing.
#include <gtest/gtest.h>

#include "tests/models/network_fixture.hpp"

namespace takt::models::large_network_test {
namespace {

using namespace test;

/// 30 bridges in a ring, 20 hosts each; every host sends to a host three bridges on and to a group.
NetworkPlan ring() {
  PlanBuilder builder;
  std::vector<NodeIndex> bridges;
  std::vector<NodeIndex> hosts;
  for (int i = 0; i < 30; ++i) bridges.push_back(builder.bridge("sw" + std::to_string(i), 1_us));
  for (std::size_t i = 0; i < 30; ++i) builder.link(bridges[i], bridges[(i + 1) % 30], 1_Gbps, 50_ns);
  for (std::size_t i = 0; i < 600; ++i) {
    hosts.push_back(builder.host("host" + std::to_string(i)));
    builder.link(hosts.back(), bridges[i % 30], 100_Mbps, 50_ns);
  }
  for (std::size_t i = 0; i < 600; ++i) {
    const StreamIndex one =
        builder.stream(hosts[i], {hosts[(i + 3) % 600]}, {static_cast<Priority>(i % 8), 0, Octets{0}});
    builder.talk(one, Octets{static_cast<std::uint32_t>(50 + i)}, PeriodicSchedule{0_us, 500_us, 100_us});
    if (i % 10 != 0) continue;
    const StreamIndex group =
        builder.stream(hosts[i], {hosts[(i + 1) % 600], hosts[(i + 2) % 600], hosts[(i + 300) % 600]});
    builder.talk(group, 100_B, ExponentialSchedule{0_us, 1_ms});
  }
  for (QueueLimit& limit : builder.plan.port_configs[0].queue_limits) limit.frames = 3;
  return builder.plan;
}

TEST(LargeNetwork, LookingAheadChangesNothing) {
  NetworkRun ahead(ring());
  NetworkRun shuffled(ring(), 1, 0x5EED);  // the loop with the tie shuffle never looks ahead
  // The last port that was connected bears the greatest id but those of the talkers.
  ASSERT_GE(ahead.network->ports(NodeIndex{629})[0].id().index + ahead.network->plan().talkers.size(), 2048u);
  ahead.until(20_ms);
  shuffled.until(20_ms);
  EXPECT_EQ(ahead.digest(), shuffled.digest());
  EXPECT_EQ(ahead.simulation.event_count(), shuffled.simulation.event_count());
  std::uint64_t delivered = 0;
  std::uint64_t dropped = 0;
  for (const Stream& stream : ahead.network->traffic().streams()) {
    delivered += stream.delivered;
    dropped += stream.dropped_in_all();
  }
  EXPECT_GT(delivered, 20'000u);
  EXPECT_GT(dropped, 0u);
}

}  // namespace
}  // namespace takt::models::large_network_test
