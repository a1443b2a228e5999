// SPDX-License-Identifier: Apache-2.0
// Two histories side by side: what counts as the same, and which orders between participants are demanded.
#include "emulate/comparison.hpp"

#include <gtest/gtest.h>

namespace takt::emulate::comparison_test {
namespace {

using handshake::PublishedState;
using handshake::StateChange;

constexpr StateChange init{0, PublishedState::Halted, PublishedState::HaltedInit};
constexpr StateChange ready{1, PublishedState::HaltedInit, PublishedState::Ready};
constexpr StateChange running{2, PublishedState::Ready, PublishedState::Running};
constexpr StateChange halted{3, PublishedState::Running, PublishedState::Halted};

const std::vector<std::string> names = {"plc", "left", "right"};

/// A start at the master and a halt at participant 2.
History start_and_halt() {
  return {{{10, 0, init},
           {11, 1, init},
           {12, 2, init},
           {20, 1, ready},
           {21, 2, ready},
           {30, 0, ready},
           {40, 2, running},
           {41, 1, running},
           {50, 0, running},
           {60, 2, halted},
           {61, 0, halted},
           {62, 1, halted}},
          {{10, 0, program::Method::Start}, {60, 2, program::Method::Halt}}};
}

Change& of(History& history, std::uint8_t participant, const StateChange& change) {
  for (Change& each : history.changes)
    if (each.participant == participant && each.change == change) return each;
  throw std::logic_error("no such change");
}

TEST(Comparison, OfEqualHistories) {
  const Comparison comparison = compare(start_and_halt(), start_and_halt(), names);
  EXPECT_TRUE(comparison.is_same());
  // Barrier: 3 for each slave. The start's caller before two others, the halt's before two others.
  EXPECT_EQ(comparison.orders, 6u + 2u + 2u);
}

TEST(Comparison, TimesDoNotCountWhereTheOrderIsFree) {
  History emulated = start_and_halt();
  of(emulated, 1, ready).time = 22;  // after the other slave
  of(emulated, 1, halted).time = 61;
  of(emulated, 0, halted).time = 900;  // after the other slave
  EXPECT_TRUE(compare(start_and_halt(), emulated, names).is_same());
}

TEST(Comparison, AMissingTransitionIsSeen) {
  History emulated = start_and_halt();
  std::erase_if(emulated.changes, [](const Change& each) { return each.participant == 1 && each.change == halted; });
  const Comparison comparison = compare(start_and_halt(), emulated, names);
  EXPECT_FALSE(comparison.is_same());
  EXPECT_TRUE(comparison.participants[0].same);
  EXPECT_FALSE(comparison.participants[1].same);
  EXPECT_TRUE(comparison.violated.empty());
}

struct Broken {
  std::uint8_t participant;
  StateChange change;
  std::int64_t time;
  const char* what;
};

class Orders : public ::testing::TestWithParam<Broken> {};

TEST_P(Orders, AreDemanded) {
  History emulated = start_and_halt();
  of(emulated, GetParam().participant, GetParam().change).time = GetParam().time;
  const Comparison comparison = compare(start_and_halt(), emulated, names);
  EXPECT_FALSE(comparison.is_same()) << GetParam().what;
  for (const ParticipantComparison& each : comparison.participants) EXPECT_TRUE(each.same);
  ASSERT_FALSE(comparison.violated.empty());
}

INSTANTIATE_TEST_SUITE_P(All, Orders,
                         ::testing::Values(Broken{0, ready, 20, "the master is Ready with the first slave"},
                                           Broken{1, running, 29, "a slave runs before the master is Ready"},
                                           Broken{0, running, 40, "the master runs before the second slave"},
                                           Broken{1, init, 9, "a slave goes to INIT before the start"},
                                           Broken{0, halted, 60, "the master halts before the slave that was asked"}));

TEST(Comparison, WhatTheSimulationLeavesOpenIsNotDemanded) {
  History simulated = start_and_halt();
  History emulated = start_and_halt();
  of(simulated, 1, halted).time = 60;  // at the same instant as the slave that was asked
  of(emulated, 1, halted).time = 59;
  EXPECT_TRUE(compare(simulated, emulated, names).is_same());
}

}  // namespace
}  // namespace takt::emulate::comparison_test
