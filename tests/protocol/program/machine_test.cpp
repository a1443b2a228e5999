// SPDX-License-Identifier: Apache-2.0
#include "program/machine.hpp"

#include <gtest/gtest.h>

#include <array>

namespace takt::program::machine_test {
namespace {

/// A machine in a state, reached by legal calls from Ready.
Machine machine_in(State state) {
  Machine machine(State::Ready);
  if (state == State::Halted) machine.call(Method::Halt);
  if (state == State::Running || state == State::Suspended) machine.call(Method::Start);
  if (state == State::Suspended) machine.call(Method::Suspend);
  EXPECT_EQ(machine.state(), state);
  return machine;
}

// Part 10, 4.2.7, with Reset in Suspended as in the nodeset: the transition that each method causes in each state.
TEST(Machine, EveryMethodInEveryState) {
  //                          Start Suspend Resume Halt Reset
  constexpr std::array<std::array<std::uint8_t, 5>, 4> expected{{
      {0, 0, 0, 0, 1},  // Halted
      {2, 0, 0, 9, 0},  // Ready
      {0, 5, 0, 3, 0},  // Running
      {0, 0, 6, 7, 8},  // Suspended
  }};
  for (const StateInfo& state : states) {
    for (const MethodInfo& method : methods) {
      SCOPED_TRACE(std::string(state.name) + "." + std::string(method.name));
      Machine machine = machine_in(state.state);
      const Machine before = machine;
      const std::uint8_t number = expected[index_of(state.state)][index_of(method.method)];
      const StatusCode status = machine.call(method.method);
      if (number == 0) {
        EXPECT_EQ(status, StatusCode::BadInvalidState);
        EXPECT_EQ(machine, before);
        EXPECT_EQ(transition_caused_by(method.method, state.state), nullptr);
      } else {
        EXPECT_EQ(status, StatusCode::Good);
        EXPECT_EQ(machine.last_transition(), number);
        EXPECT_EQ(machine.state(), transition_with_number(number)->to);
      }
    }
  }
}

TEST(Machine, EveryTransitionLeavesItsStateOnly) {
  for (const Transition& transition : transitions) {
    for (const StateInfo& state : states) {
      Machine machine = machine_in(state.state);
      if (state.state == transition.from) {
        machine.apply(transition);
        EXPECT_EQ(machine.state(), transition.to);
        EXPECT_EQ(machine.last_transition(), transition.number);
      } else {
        EXPECT_THROW(machine.apply(transition), sim::InvariantBroken);
        EXPECT_EQ(machine.state(), state.state);
      }
    }
  }
}

TEST(Machine, InitIsASubstateOfHalted) {
  Machine machine;
  EXPECT_TRUE(machine.at_rest());
  EXPECT_EQ(machine.last_transition(), 0);
  EXPECT_THROW(machine.leave_init(), sim::InvariantBroken);
  machine.enter_init();
  EXPECT_EQ(machine.state(), State::Halted);
  EXPECT_TRUE(machine.initialising());
  EXPECT_FALSE(machine.at_rest());
  EXPECT_THROW(machine.enter_init(), sim::InvariantBroken);
  machine.leave_init();
  EXPECT_TRUE(machine.at_rest());
  machine.enter_init();
  machine.apply(*transition_between(State::Halted, State::Ready));
  EXPECT_FALSE(machine.initialising());
  EXPECT_THROW(machine.enter_init(), sim::InvariantBroken);
}

TEST(Machine, BeginsHaltedOrReady) {
  EXPECT_EQ(Machine(State::Ready).state(), State::Ready);
  EXPECT_THROW(Machine{State::Running}, sim::InvariantBroken);
  EXPECT_THROW(Machine{State::Suspended}, sim::InvariantBroken);
}

}  // namespace
}  // namespace takt::program::machine_test
