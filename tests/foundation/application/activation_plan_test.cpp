// SPDX-License-Identifier: Apache-2.0
// Which activation is answered, how long after, and which are missed.
#include "application/activation_plan.hpp"

#include <gtest/gtest.h>

#include "application/activation_grid.hpp"

namespace takt::application::activation_plan_test {
namespace {

using namespace sim::literals;  // NOLINT: units

ActivationPlan plan_with(const sim::Distribution& response) {
  return {10_ms, response, sim::RandomStream(1, "host/app/thread", "response")};
}

TEST(ActivationPlan, AnswersEachInTime) {
  const auto law = sim::Distribution::constant(3_ms);
  ActivationPlan plan = plan_with(law);
  plan.begin(7);
  EXPECT_EQ(plan.number(), 7);
  EXPECT_TRUE(plan.is_call());
  EXPECT_EQ(plan.response(), 3_ms);
  plan.next();
  EXPECT_EQ(plan.number(), 8);
}

// A response that is over when the next activation is due is too late; 64 draws later it is tried again, and nothing
// was answered.
TEST(ActivationPlan, AResponseOfAnIntervalIsTooLong) {
  const auto law = sim::Distribution::constant(10_ms);
  ActivationPlan plan = plan_with(law);
  plan.begin(0);
  EXPECT_FALSE(plan.is_call());
  EXPECT_EQ(plan.number(), 64);
  EXPECT_EQ(plan.response(), sim::Duration());
  plan.next();
  EXPECT_EQ(plan.number(), 128);
}

// Of 1000 activations half draw 12 ms and are missed; those between two calls belong to the numbers that were jumped
// over.
TEST(ActivationPlan, MissesAsManyAsTheLawSays) {
  const auto law = sim::Distribution::empirical({{2_ms, 1}, {12_ms, 1}});
  ActivationPlan plan = plan_with(law);
  int calls = 0;
  for (plan.begin(0); plan.number() < 1000; plan.next()) {
    EXPECT_EQ(plan.response(), 2_ms);
    ++calls;
  }
  EXPECT_NEAR(calls, 500, 80);  // five standard deviations of 15.8
}

// Due at 3, 13, 23 ...: at 42 the one of 33 is open, at 43 it is over.
TEST(ActivationGrid, WhatIsDueIsDecidedWhenTheNextOneIs) {
  const ActivationGrid grid{10, 3};
  EXPECT_EQ(grid.decided(0, -1, 2), 0);
  EXPECT_EQ(grid.decided(0, -1, 42), 3);
  EXPECT_EQ(grid.decided(0, -1, 43), 4);
  EXPECT_EQ(grid.decided(0, 3, 42), 4);  // done is decided
  EXPECT_EQ(grid.decided(0, 3, 5), 4);   // even if the clock goes back
}

}  // namespace
}  // namespace takt::application::activation_plan_test
