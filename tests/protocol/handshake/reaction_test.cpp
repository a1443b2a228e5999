// SPDX-License-Identifier: Apache-2.0
#include "handshake/reaction.hpp"

#include <gtest/gtest.h>

#include "group.hpp"

namespace takt::handshake {
namespace {

using program::Method;
using sim::TrueTime;

TrueTime at(std::int64_t us) { return TrueTime::from_ps(us * 1'000'000); }

void expect(const Reaction& reaction, IntentKind kind, std::uint8_t initiator, ReactionOutcome outcome,
            std::int64_t began_us, TrueTime completed) {
  EXPECT_EQ(reaction.kind, kind);
  EXPECT_EQ(reaction.initiator, initiator);
  EXPECT_EQ(reaction.outcome, outcome);
  EXPECT_EQ(reaction.began, at(began_us));
  EXPECT_EQ(reaction.completed, completed);
}

class Reactions : public testing::TestWithParam<Variant> {};
INSTANTIATE_TEST_SUITE_P(Variants, Reactions, testing::Values(Variant::paper, Variant::robust));

TEST_P(Reactions, FromTheCommandToTheLastToFollow) {
  Group group(GetParam(), 2);
  group.now = at(10);
  group.call(0, Method::Start);
  for (int us = 11; us < 16; ++us) {
    group.now = at(us);
    group.round();
  }
  // Round 11: the slaves enter INIT after the master has published, are Ready and tell it: the master is Ready and all
  // else follows in the next rounds: 12 slaves Running, and the master with the last of their words.
  group.now = at(20);
  group.call(1, Method::Suspend);
  group.now = at(21);
  group.tell(1, 0);
  group.now = at(25);
  group.tell(0, 2);
  group.now = at(30);
  EXPECT_EQ(group.call(2, Method::Suspend).status, program::StatusCode::BadInvalidState);
  group.call(2, Method::Halt);
  group.rounds(2);
  ASSERT_EQ(group.reactions.reactions().size(), 3U) << "a refused call is no reaction";
  expect(group.reactions.reactions()[0], IntentKind::Start, 0, ReactionOutcome::completed, 10, at(12));
  expect(group.reactions.reactions()[1], IntentKind::Suspend, 1, ReactionOutcome::completed, 20, at(25));
  expect(group.reactions.reactions()[2], IntentKind::Halt, 2, ReactionOutcome::completed, 30, at(30));
}

TEST_P(Reactions, AHaltSupersedesAStart) {
  Group group(GetParam(), 2);
  group.now = at(1);
  group.call(0, Method::Start);
  group.notify_all(0);
  group.tell(1, 0);
  group.now = at(2);
  group.call(1, Method::Halt);
  group.rounds(2);
  ASSERT_EQ(group.reactions.reactions().size(), 2U);
  expect(group.reactions.reactions()[0], IntentKind::Start, 0, ReactionOutcome::superseded, 1, TrueTime::never());
  expect(group.reactions.reactions()[1], IntentKind::Halt, 1, ReactionOutcome::completed, 2, at(2));
}

TEST(Reaction, TwoHaltsAtOnceBothComplete) {
  Group group = started(Variant::robust, 2);
  group.now = at(5);
  group.call(1, Method::Halt);
  group.now = at(6);
  group.call(2, Method::Halt);
  group.now = at(9);
  group.rounds(2);
  ASSERT_EQ(group.reactions.reactions().size(), 3U);
  expect(group.reactions.reactions()[1], IntentKind::Halt, 1, ReactionOutcome::completed, 5, at(9));
  expect(group.reactions.reactions()[2], IntentKind::Halt, 2, ReactionOutcome::completed, 6, at(9));
}

TEST(Reaction, TheLesserIntentIsSupersededWhicheverBeganFirst) {
  Group group = started(Variant::robust, 2);
  group.call(0, Method::Suspend);
  group.rounds(2);
  group.now = at(5);
  group.call(1, Method::Reset);
  group.now = at(6);
  group.call(2, Method::Resume);  // later, but the same number and a lesser kind
  group.now = at(9);
  group.rounds(2);
  const auto reactions = group.reactions.reactions();
  ASSERT_EQ(reactions.size(), 4U);
  expect(reactions[2], IntentKind::Reset, 1, ReactionOutcome::completed, 5, at(9));
  expect(reactions[3], IntentKind::Resume, 2, ReactionOutcome::superseded, 6, TrueTime::never());
}

TEST(Reaction, FinishAndAlarmsAreReactionsToo) {
  Group group = started(Variant::robust, 1);
  group.now = at(5);
  group.step(1, Input::finished());
  group.round();
  group.now = at(7);
  group.step(0, Input::peer_silent(0));
  group.round();
  const auto reactions = group.reactions.reactions();
  ASSERT_EQ(reactions.size(), 3U);
  expect(reactions[1], IntentKind::Finish, 1, ReactionOutcome::completed, 5, at(5));
  expect(reactions[2], IntentKind::Halt, 0, ReactionOutcome::completed, 7, at(7));
  EXPECT_EQ(reactions[2].cause, Cause::silence);
}

// A crash at 5 us: the reaction begins there, whoever notices it, and is over when all who live have halted.
TEST(Reaction, FromTheCrashToTheLastWhoLives) {
  Group group = started(Variant::robust, 3);
  group.reactions.on_crash(3, at(5));
  group.now = at(15);
  group.step(0, Input::peer_silent(2));
  group.now = at(16);
  group.tell(0, 1);
  group.step(2, Input::peer_silent(0));  // who notices it second begins nothing
  const auto reactions = group.reactions.reactions();
  ASSERT_EQ(reactions.size(), 2U);
  expect(reactions[1], IntentKind::Halt, 3, ReactionOutcome::completed, 5, at(16));
  EXPECT_EQ(reactions[1].cause, Cause::crash);
}

TEST(Reaction, ACommandDoesNotSupersedeTheHaltThatACrashAsksFor) {
  Group group = started(Variant::robust, 2);
  group.reactions.on_crash(2, at(5));
  group.now = at(6);
  group.call(0, Method::Suspend);
  group.tell(0, 1);
  group.now = at(15);
  group.step(0, Input::peer_silent(1));
  group.tell(0, 1);
  const auto reactions = group.reactions.reactions();
  ASSERT_EQ(reactions.size(), 3U);
  expect(reactions[1], IntentKind::Halt, 2, ReactionOutcome::completed, 5, at(15));
  expect(reactions[2], IntentKind::Suspend, 0, ReactionOutcome::completed, 6, at(6));
}

TEST(Reaction, ACrashInHaltedAsksForNothing) {
  Group group(Variant::robust, 2);
  group.reactions.on_crash(1, at(5));
  EXPECT_TRUE(group.reactions.reactions().empty());
  // Started without it, the master finds it silent: from its own INIT, which is when the silence began to matter.
  group.now = at(20);
  group.call(0, Method::Start);
  group.now = at(30);
  Outputs outputs;
  outputs.raised = true;
  outputs.alarm = Alarm::peer_silent;
  group.reactions.on_step(0, outputs, Word{}, at(30), {Cause::crash, at(5)});
  const auto reactions = group.reactions.reactions();
  ASSERT_EQ(reactions.size(), 2U);
  EXPECT_EQ(reactions[1].cause, Cause::crash);
  EXPECT_EQ(reactions[1].began, at(20));
}

// A group that goes on by itself after a replacement has reacted when all run again.
TEST(Reaction, AStartByItselfIsOfTheLastFault) {
  ReactionTracker tracker(2);
  const auto step = [&](std::size_t who, IntentKind kind, Alarm alarm, PublishedState from, PublishedState to,
                        TrueTime when, const Origin& origin = {}) {
    Outputs outputs;
    outputs.raised = who == 0;
    outputs.raised_kind = kind;
    outputs.alarm = alarm;
    outputs.add({1, from, to});
    tracker.on_step(who, outputs, Word{}, when, origin);
  };
  step(0, IntentKind::Start, Alarm::none, PublishedState::Halted, PublishedState::Running, at(1));
  step(1, IntentKind::Start, Alarm::none, PublishedState::Halted, PublishedState::Running, at(2));
  tracker.on_crash(1, at(5));
  step(0, IntentKind::Halt, Alarm::peer_silent, PublishedState::Running, PublishedState::Halted, at(15));
  tracker.on_restart(1, at(16));
  step(0, IntentKind::Start, Alarm::none, PublishedState::Halted, PublishedState::Running, at(17),
       {Cause::command, TrueTime::never(), true});
  step(1, IntentKind::Start, Alarm::none, PublishedState::Halted, PublishedState::Running, at(19));
  ASSERT_EQ(tracker.reactions().size(), 3U);
  expect(tracker.reactions()[1], IntentKind::Halt, 1, ReactionOutcome::completed, 5, at(15));
  expect(tracker.reactions()[2], IntentKind::Start, 0, ReactionOutcome::completed, 5, at(19));
  EXPECT_EQ(tracker.reactions()[2].cause, Cause::crash);
}

TEST(Reaction, WithoutTheLastFollowerItStaysPending) {
  Group group = started(Variant::robust, 2);
  group.call(0, Method::Suspend);
  group.tell(0, 1);
  ASSERT_EQ(group.reactions.reactions().size(), 2U);
  EXPECT_EQ(group.reactions.reactions()[1].outcome, ReactionOutcome::pending);
  EXPECT_EQ(group.reactions.reactions()[1].completed, TrueTime::never());
}

}  // namespace
}  // namespace takt::handshake
