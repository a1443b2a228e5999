// SPDX-License-Identifier: Apache-2.0
#include "node/applications/deadlines.hpp"

#include <gtest/gtest.h>

#include "scenario/applications/activations.hpp"

namespace takt::node {
namespace {

/// Due at 3, 13, 23, 33 ... ns; it begins at 27.
Deadlines with(const sim::Distribution& response) {
  return {{10, 3}, {sim::Duration::from_ps(10'000), response, sim::RandomStream(1, "a", "response")}, 27};
}
sim::Distribution constant_ns(std::int64_t ns) {
  return sim::Distribution::constant(sim::Duration::from_ps(ns * 1000));
}

TEST(Deadlines, WhatWasOverBeforeItWasAnsweredIsMissed) {
  const auto law = constant_ns(0);
  Deadlines deadlines = with(law);
  EXPECT_EQ(deadlines.due(), 33);
  EXPECT_EQ(deadlines.at(), 33);
  EXPECT_EQ(deadlines.number(), 3);
  EXPECT_TRUE(deadlines.awake(42));
  EXPECT_EQ(deadlines.missed(42), 0u);
  deadlines.next();
  EXPECT_EQ(deadlines.due(), 43);
  EXPECT_TRUE(deadlines.awake(65));  // 53 and 63 are due too; the call at 65 answers the last
  EXPECT_EQ(deadlines.missed(65), 2u);
  EXPECT_EQ(deadlines.due(), 63);
  deadlines.next();
  EXPECT_EQ(deadlines.due(), 73);
  EXPECT_EQ(deadlines.missed(72), 2u);
}

// Each is answered 4 ns after it is due. Who sleeps until 65 has missed those of 43 and 53, and answers that of 63
// at 67.
TEST(Deadlines, AResponseIsWaitedFor) {
  const auto law = constant_ns(4);
  Deadlines deadlines = with(law);
  EXPECT_EQ(deadlines.due(), 33);
  EXPECT_EQ(deadlines.at(), 37);
  EXPECT_TRUE(deadlines.awake(39));
  deadlines.next();
  EXPECT_EQ(deadlines.at(), 47);
  EXPECT_FALSE(deadlines.awake(65));
  EXPECT_EQ(deadlines.at(), 67);
  EXPECT_TRUE(deadlines.awake(67));
  EXPECT_EQ(deadlines.missed(67), 2u);
  deadlines.next();
  EXPECT_EQ(deadlines.missed(72), 2u);
}

// 64 draws in one go: it looks again when number 3 + 64 is due, at 673, when those before are missed.
TEST(Deadlines, AResponseThatIsAlwaysTooLongMissesAll) {
  const auto law = constant_ns(10);
  Deadlines deadlines = with(law);
  EXPECT_EQ(deadlines.at(), 673);
  EXPECT_EQ(deadlines.missed(43), 1u);
  EXPECT_FALSE(deadlines.awake(673));
  EXPECT_EQ(deadlines.missed(673), 64u);
  EXPECT_EQ(deadlines.number(), 131);
}

// A node that is always let run in time answers the activations that the simulated thread of the same seed answers, as
// long after.
TEST(Deadlines, ResponsesAreThoseOfTheSimulatedThread) {
  using namespace sim::literals;  // NOLINT: units
  const auto law = sim::Distribution::weibull(1_ms + 100_us, 0.9);
  const std::vector<sim::Duration> instants = {sim::Duration()};
  scenario::Activations simulated(2_ms, 0_ms, law, 5, "update/updater/publish", instants);
  simulated.begin(sim::LocalTime());
  Deadlines real({2'000'000, 0}, {2_ms, law, sim::RandomStream(5, "update/updater/publish", "response")}, -1);
  int missed = 0;
  std::int64_t before = -1;
  for (int calls = 0; calls < 500;) {
    const sim::LocalTime at = simulated.next();
    const auto call = simulated.act();
    if (!call) continue;
    ++calls;
    ASSERT_EQ(real.number(), call->activation);
    ASSERT_EQ(real.at(), at.ps() / 1000);
    ASSERT_TRUE(real.awake(real.at()));
    missed += static_cast<int>(call->activation - before - 1);
    before = call->activation;
    real.next();
  }
  EXPECT_GT(missed, 0);
  EXPECT_EQ(real.missed(before * 2'000'000), static_cast<std::uint64_t>(missed));
}

}  // namespace
}  // namespace takt::node
