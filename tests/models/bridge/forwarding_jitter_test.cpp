// SPDX-License-Identifier: Apache-2.0
// Forwarding delays that differ from frame to frame. Minimum frames at 1 Gb/s occupy the medium for 672 ns and are
// there after 576.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "tests/models/network_fixture.hpp"

namespace takt::models::forwarding_jitter_test {
namespace {

using namespace test;

std::vector<Listener::Arrival> arrivals(const sim::Distribution& jitter, const std::vector<Duration>& times,
                                        std::uint64_t* digest = nullptr) {
  Line line(1, 1_Gbps, 0_ns, 920_ns);
  line.builder.plan.nodes[1].forwarding_jitter = std::make_shared<const sim::Distribution>(jitter);
  const StreamIndex stream = line.builder.stream(line.talker, {line.listener});
  std::vector<Sender::Item> items;
  for (const Duration time : times) items.push_back({local(time), stream, 8});
  NetworkRun run(line.builder.plan);
  install<Sender>(*run.network, line.talker, "sender", items);
  const Listener& log = listen(*run.network, line.listener, {stream});
  run.until(1_s);
  if (digest != nullptr) *digest = run.digest();
  EXPECT_EQ(run.network->traffic().live_frames(), 0u);
  return log.arrivals;
}

// 576 + 920 + 80 + 576 ns.
TEST(ForwardingJitter, AddsToTheFixedDelay) {
  const auto one = arrivals(sim::Distribution::constant(80_ns), {0_ns});
  ASSERT_EQ(one.size(), 1u);
  EXPECT_EQ(one[0].time, local(2'152_ns));
}

// Frames far from each other: each between 2072 and 2232 ns, near both ends, and on average in the middle (160 / sqrt
// 12 ns of deviation, over the root of 1000).
TEST(ForwardingJitter, LiesBetweenItsEnds) {
  std::vector<Duration> times;
  for (int i = 0; i < 1000; ++i) times.push_back(10_us * i);
  std::uint64_t first = 0, second = 0;
  const auto all = arrivals(sim::Distribution::uniform(0_ns, 160_ns), times, &first);
  ASSERT_EQ(all.size(), times.size());
  std::int64_t least = 1'000'000'000, greatest = 0, sum = 0;
  for (std::size_t i = 0; i < all.size(); ++i) {
    const std::int64_t latency = (all[i].time - local(times[i])).ps();
    least = std::min(least, latency);
    greatest = std::max(greatest, latency);
    sum += latency;
  }
  EXPECT_GE(least, 2'072'000);
  EXPECT_LT(least, 2'074'000);
  EXPECT_LE(greatest, 2'232'000);
  EXPECT_GT(greatest, 2'230'000);
  EXPECT_NEAR(static_cast<double>(sum) / 1000, 2'152'000, 4 * 160'000 / std::sqrt(12.0 * 1000));
  arrivals(sim::Distribution::uniform(0_ns, 160_ns), times, &second);
  EXPECT_EQ(first, second);
}

// Frames 672 ns apart of which one may take 100 us longer than the next: in order, none closer behind another than the
// wire allows, and some that have waited for one before.
TEST(ForwardingJitter, NobodyOvertakes) {
  const auto all = arrivals(sim::Distribution::uniform(0_ns, 100_us), std::vector<Duration>(500, 0_ns));
  ASSERT_EQ(all.size(), 500u);
  std::size_t close = 0;
  for (std::size_t i = 1; i < all.size(); ++i) {
    EXPECT_EQ(all[i].sequence, i);
    EXPECT_GE(all[i].time, all[i - 1].time + 672_ns);
    close += all[i].time == all[i - 1].time + 672_ns ? 1u : 0u;
  }
  EXPECT_GT(close, 250u);
  EXPECT_LE(all.back().time, local(499 * 672_ns + 576_ns + 920_ns + 100_us + 576_ns + 500 * 672_ns));
}

}  // namespace
}  // namespace takt::models::forwarding_jitter_test
