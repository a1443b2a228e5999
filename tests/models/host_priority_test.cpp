// SPDX-License-Identifier: Apache-2.0
// Untagged frames that their own host queues by a priority. Minimum frames at 1 Gb/s occupy the medium for 672 ns and
// are there after 576.
#include <gtest/gtest.h>

#include "tests/models/network_fixture.hpp"

namespace takt::models::host_priority_test {
namespace {

using namespace test;

/// Three frames at the start, and one of another stream 100 ns later; both untagged, over a switch.
struct Pair {
  explicit Pair(std::optional<Priority> priority, DataRate behind = 1_Gbps) {
    talker = builder.host("talker");
    sw = builder.bridge("sw");
    listener = builder.host("listener");
    builder.link(talker, sw, 1_Gbps);
    builder.link(sw, listener, behind);
    many = builder.stream(talker, {listener});
    one = builder.stream(talker, {listener});
    builder.plan.streams[one.value].host_priority = priority;
    builder.send_at(many, 8_B, {0_ns, 0_ns, 0_ns});
    builder.send_at(one, 8_B, {100_ns});
  }
  PlanBuilder builder;
  NodeIndex talker, sw, listener;
  StreamIndex many, one;
};

// The frame goes before the two that wait: it starts at 672 ns, and has come over the switch 1152 ns later. Without the
// priority it is the last, 3 * 672 ns behind the first.
TEST(HostPriority, CountsAtTheHost) {
  for (const bool has_priority : {true, false}) {
    Pair pair(has_priority ? std::optional<Priority>(5) : std::nullopt);
    NetworkRun run(pair.builder.plan);
    run.until(1_ms);
    ASSERT_EQ(run.stream(pair.one).delivered, 1u);
    EXPECT_EQ(run.stream(pair.one).latency.minimum(), (has_priority ? 1'824_ns : 3'168_ns) - 100_ns);
    EXPECT_EQ(run.port(pair.talker, 0).queues().peak_frames(5), has_priority ? 1u : 0u);
    EXPECT_EQ(run.port(pair.talker, 0).queues().peak_frames(1), has_priority ? 2u : 3u);
  }
}

// The frame does not bear it: behind the host it is one of priority 0, in class 1, among the others. At 100 Mb/s the
// first frame is sent for 6.72 us, and the three others wait.
TEST(HostPriority, EndsWithTheHost) {
  Pair pair(Priority{5}, 100_Mbps);
  NetworkRun run(pair.builder.plan);
  run.until(1_ms);
  EXPECT_EQ(run.port(pair.sw, 1).queues().peak_frames(1), 3u);
  EXPECT_EQ(run.port(pair.sw, 1).queues().peak_frames(5), 0u);
  ASSERT_EQ(run.stream(pair.one).delivered, 1u);
  EXPECT_EQ(run.stream(pair.one).latency.minimum(), 576_ns + 6'720_ns + 5'760_ns - 100_ns);  // the second
}

// Where another stream has launch times in that class, frames without one are due at once.
TEST(HostPriority, BesideLaunchTimes) {
  Pair pair(Priority{5});
  PortConfig config;
  config.shaping.selection[5] = TimeBased{};
  pair.builder.plan.nodes[pair.talker.value].port_config = pair.builder.port_config(config);
  const StreamIndex launched = pair.builder.stream(pair.talker, {pair.listener}, {Priority{5}, 0, Octets{0}});
  pair.builder.send_at(launched, 8_B, {0_ns});
  pair.builder.plan.talkers.back().launch = 50_us;
  NetworkRun run(pair.builder.plan);
  run.until(1_ms);
  ASSERT_EQ(run.stream(pair.one).delivered, 1u);
  EXPECT_EQ(run.stream(pair.one).latency.minimum(), 1'824_ns - 100_ns);
  EXPECT_EQ(run.stream(launched).latency.minimum(), 50_us + 1'152_ns);
  EXPECT_EQ(run.stream(pair.one).dropped_in_all(), 0u);
}

}  // namespace
}  // namespace takt::models::host_priority_test
