// SPDX-License-Identifier: Apache-2.0
// When a key service is asked: by its schedule, after failures, and at once for what was heard, however often that is.
#include "security/pull_plan.hpp"

#include <gtest/gtest.h>

namespace takt::security::pull_plan_test {
namespace {

constexpr std::int64_t s = 1'000'000'000;

TEST(PullPlan, IsDueAtOnceAndThenByTheSchedule) {
  PullPlan plan;
  EXPECT_LE(plan.next_ns(), 0);
  plan.gave(10 * s, 1810 * s, true);
  EXPECT_EQ(plan.next_ns(), 1810 * s);
  EXPECT_FALSE(plan.is_wished());
}

TEST(PullPlan, FailuresAreLongerAndLongerApart) {
  PullPlan plan;
  // Half a second, one, two, ... and half a minute, of which at least a half: the chance is 0.
  for (const std::int64_t half_ns : {s / 4, s / 2, s, 2 * s, 4 * s, 8 * s, 15 * s, 15 * s, 15 * s}) {
    const std::int64_t now = 100 * s;
    plan.failed(now, 0);
    EXPECT_EQ(plan.next_ns(), now + half_ns);
  }
  plan.failed(100 * s, 255);
  EXPECT_GT(plan.next_ns(), 129 * s);
  EXPECT_LE(plan.next_ns(), 130 * s);
  plan.gave(200 * s, 300 * s, true);
  plan.failed(300 * s, 0);
  EXPECT_EQ(plan.next_ns(), 300 * s + s / 4) << "a success is a new beginning";
}

TEST(PullPlan, AWishIsDueAtOnce) {
  PullPlan plan;
  plan.gave(10 * s, 1810 * s, true);
  plan.wished(10 * s + s / 2);
  EXPECT_EQ(plan.next_ns(), 1810 * s) << "it was asked just now";
  plan.wished(20 * s);
  EXPECT_EQ(plan.next_ns(), 20 * s);
  EXPECT_TRUE(plan.is_wished());
  plan.wished(21 * s);
  EXPECT_EQ(plan.next_ns(), 20 * s) << "it is due already";
  plan.gave(20 * s, 1820 * s, true);
  EXPECT_EQ(plan.next_ns(), 1820 * s);
  EXPECT_FALSE(plan.is_wished());
}

TEST(PullPlan, AWishShortensTheTimeAfterAFailure) {
  PullPlan plan;
  for (int i = 0; i < 10; ++i) plan.failed(100 * s, 255);
  plan.wished(101 * s);
  EXPECT_EQ(plan.next_ns(), 101 * s) << "who speaks with new keys has got them somewhere";
}

// A stranger sends a token that there is none of, all the time: 1, 2, 4, ... 64 s lie between the pulls that bring
// nothing, so in an hour there are 7 until they lie so far apart, and (3600 - 127) / 64.
TEST(PullPlan, AFloodOfWishesIsBounded) {
  PullPlan plan;
  std::int64_t pulls = 0;
  const std::int64_t next = 100'000 * s;
  plan.gave(0, next, true);
  for (std::int64_t now = 0; now < 3600 * s; now += s / 100) {
    plan.wished(now);
    if (plan.next_ns() > now) continue;
    ++pulls;
    plan.gave(now, next, false);
  }
  EXPECT_EQ(pulls, 7 + 1 + (3600 - 127 - 1) / 64);
  // Keys that are new put an end to that.
  plan.wished(4000 * s);
  plan.gave(4000 * s, next, true);
  plan.wished(4001 * s);
  EXPECT_EQ(plan.next_ns(), 4001 * s);
}

}  // namespace
}  // namespace takt::security::pull_plan_test
