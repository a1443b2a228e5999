// SPDX-License-Identifier: Apache-2.0
// Substates: INIT below Halted, and a machine of a user's own below Running (Part 10, Annex A: a download).
#include "program/nested_machine.hpp"

#include <gtest/gtest.h>

#include "program/program.hpp"

namespace takt::program::nested_machine_test {
namespace {

sim::LocalTime at(std::int64_t ms) { return sim::LocalTime::from_ps(ms * 1'000'000'000); }

constexpr std::array<Substate, 3> phases{{{1, "Opening"}, {2, "Sending"}, {3, "Closing"}}};
constexpr std::array<Subtransition, 4> steps{{{1, "RunningToOpening", 0, 1},
                                              {2, "OpeningToSending", 1, 2},
                                              {3, "SendingToClosing", 2, 3},
                                              {4, "ClosingToRunning", 3, 0}}};
constexpr NestedDescription download{State::Running, phases, steps, 1};
static_assert(is_sound(download) && is_sound(init_machine));

constexpr std::array<Subtransition, 1> dangling{{{1, "OpeningToNowhere", 1, 9}}};
static_assert(!is_sound(NestedDescription{State::Running, phases, dangling}));
static_assert(!is_sound(NestedDescription{State::Running, phases, steps, 7}));

Program downloader() {
  ProgramSettings settings;
  settings.name = "download";
  settings.nested = {init_machine, download};
  return Program(settings, {}, at(0));
}
Outcome call(Program& program, Method method, std::int64_t ms) {
  Call call;
  call.method = method;
  return program.call(call, at(ms));
}

TEST(NestedMachines, InitIsOne) {
  Program program = downloader();
  EXPECT_EQ(program.nested(State::Halted)->current_number(), 0u);
  EXPECT_EQ(program.nested(State::Running)->status(), StatusCode::BadStateNotActive);
  const Outcome entered = program.go_to_substate(15, at(1));
  ASSERT_EQ(entered.events.size(), 1u);
  EXPECT_TRUE(entered.events[0].nested);
  EXPECT_EQ(entered.events[0].transition_name, "HaltedToInit");
  EXPECT_EQ(entered.events[0].from_name, "Halted");
  EXPECT_EQ(entered.events[0].to_name, "Init");
  EXPECT_TRUE(program.machine().initialising());
  EXPECT_EQ(program.machine().last_transition(), 0) << "none of the nine";
  EXPECT_EQ(program.go_to_substate(15, at(2)).status, StatusCode::BadInvalidState);
  // Halted.Init to Ready: out of Init, then transition 1, at one time.
  const Outcome left = program.advance(1, at(3));
  ASSERT_EQ(left.events.size(), 2u);
  EXPECT_EQ(left.events[0].transition_name, "InitToHalted");
  EXPECT_EQ(left.events[1].transition_number, 1u);
  EXPECT_EQ(left.events[0].time, left.events[1].time);
  EXPECT_FALSE(program.machine().initialising());
  EXPECT_EQ(program.nested(State::Halted)->current_number(), std::nullopt);
}

TEST(NestedMachines, AUsersOwnBelowRunning) {
  Program program = downloader();
  EXPECT_EQ(program.go_to_substate(2, at(1)).status, StatusCode::BadInvalidState) << "no such substate of Halted";
  program.advance(1, at(2));
  const Outcome started = call(program, Method::Start, 3);
  ASSERT_EQ(started.events.size(), 2u);
  EXPECT_EQ(started.events[0].transition_number, 2u);
  EXPECT_EQ(started.events[1].transition_name, "RunningToOpening") << "the initial substate comes with the state";
  EXPECT_EQ(program.go_to_substate(3, at(4)).status, StatusCode::BadInvalidState) << "not from Opening";
  const Outcome sending = program.go_to_substate(2, at(5), {{"percent", std::int64_t{10}}});
  EXPECT_EQ(sending.status, StatusCode::Good);
  EXPECT_EQ(sending.events.at(0).intermediate_result.at(0).name, "percent");
  EXPECT_EQ(program.nested(State::Running)->current()->name, "Sending");
  EXPECT_EQ(program.state(), State::Running);
  // A base transition ends the substate; out of Sending no transition is declared, so only the base one is told.
  const Outcome halted = call(program, Method::Halt, 6);
  ASSERT_EQ(halted.events.size(), 1u);
  EXPECT_EQ(halted.events[0].transition_number, 3u);
  EXPECT_FALSE(program.nested(State::Running)->active());
}

}  // namespace
}  // namespace takt::program::nested_machine_test
