// SPDX-License-Identifier: Apache-2.0
// The rules of `robust` one by one.
#include <gtest/gtest.h>

#include <array>
#include <initializer_list>

#include "group.hpp"

namespace takt::handshake {
namespace {

using program::Method;
using program::StatusCode;

TEST(Intent, OrderIsNumberKindOrigin) {
  const auto intent = [](std::uint32_t number, IntentKind kind, std::uint8_t origin) {
    return Intent{number, kind, origin, 0};
  };
  const auto expect_later = [](const Intent& one, const Intent& other) {
    EXPECT_EQ(standing_of(other, one), Standing::later);
    EXPECT_EQ(standing_of(one, other), Standing::earlier);
    EXPECT_EQ(standing_of(one, one), Standing::same);
  };
  expect_later(intent(1, IntentKind::Halt, 9), intent(2, IntentKind::Start, 0));
  expect_later(intent(2, IntentKind::Start, 9), intent(2, IntentKind::Resume, 0));
  expect_later(intent(2, IntentKind::Resume, 9), intent(2, IntentKind::Suspend, 0));
  expect_later(intent(2, IntentKind::Suspend, 9), intent(2, IntentKind::Finish, 0));
  expect_later(intent(2, IntentKind::Finish, 9), intent(2, IntentKind::Reset, 0));
  expect_later(intent(2, IntentKind::Reset, 9), intent(2, IntentKind::Halt, 0));
  expect_later(intent(2, IntentKind::Halt, 0), intent(2, IntentKind::Halt, 1));
  expect_later(Intent{}, intent(1, IntentKind::Start, 0));
}

// The ends of the window, all around the circle: each of two finds the other one apart, or one finds the other later
// and is found earlier.
TEST(Intent, NumbersGoRound) {
  EXPECT_EQ(next_number(7), 8U);
  EXPECT_EQ(next_number(0xFFFFFFFF), 1U) << "0 is none";
  constexpr std::uint32_t quarter = 0x40000000;
  for (const std::uint32_t from : {1U, 5U, quarter, 0x7FFFFFFFU, 0xC0000001U, 0xFFFFFFFFU}) {
    const auto expect = [from](std::uint32_t ahead, Standing there, Standing back) {
      if (from + ahead == 0) return;  // none
      EXPECT_EQ(standing_of(from + ahead, from), there) << from << " + " << ahead;
      EXPECT_EQ(standing_of(from, from + ahead), back) << from << " + " << ahead;
    };
    expect(0, Standing::same, Standing::same);
    expect(1, Standing::later, Standing::earlier);
    expect(quarter - 1, Standing::later, Standing::earlier);
    expect(quarter, Standing::apart, Standing::apart);
    expect(2 * quarter, Standing::apart, Standing::apart);
    expect(3 * quarter, Standing::apart, Standing::apart);
    expect(3 * quarter + 1, Standing::earlier, Standing::later);
    EXPECT_EQ(standing_of(0, from), Standing::earlier) << "who knows nothing learns any number";
    EXPECT_EQ(standing_of(from, 0), Standing::later);
  }
}

TEST(Intent, RunsOfTwoIncarnationsDiffer) {
  EXPECT_EQ(run_of(0, 1), 1U);
  EXPECT_EQ(run_of(2, 1), 0x20001U);
  EXPECT_EQ(run_of(0, 0xFFFF), 0xFFFFU);
  EXPECT_EQ(run_of(0, 0x10000), 1U) << "the number's part is never 0";
}

TEST(Robust, ConcurrentSuspendAndResetEndReady) {
  Group group = started(Variant::robust, 3);
  group.call(0, Method::Suspend);
  group.rounds(2);
  group.call(1, Method::Resume);
  group.call(2, Method::Reset);  // same number, greater kind
  group.rounds(3);
  EXPECT_TRUE(group.all_in(PublishedState::Ready)) << group.describe();
  EXPECT_TRUE(group.agreed());
  EXPECT_EQ(group[0].intent().origin, 2);
}

TEST(Robust, SuspendAndResumeThatCrossSettle) {
  Group group = started(Variant::robust, 1);
  group.call(0, Method::Suspend);
  group.round();
  ASSERT_TRUE(group.all_in(PublishedState::Suspended));
  group.call(0, Method::Resume);
  const Message resume = group.message(0, 1);
  group.call(0, Method::Suspend);
  const Message suspend = group.message(0, 1);
  group.deliver(resume);
  const Message echo = group.message(1, 0);
  group.deliver(suspend);
  group.deliver(echo);
  EXPECT_TRUE(group.all_in(PublishedState::Suspended)) << group.describe();
  EXPECT_TRUE(group.agreed());
}

TEST(Robust, AHaltSticksAgainstALaterResume) {
  Group group = started(Variant::robust, 2);
  group.call(1, Method::Suspend);
  group.rounds(2);
  group.call(2, Method::Halt);     // number 3
  group.call(1, Method::Resume);   // number 3, lesser
  group.call(1, Method::Suspend);  // number 4: greater than the halt
  const Outputs outputs = group.tell(1, 0);
  EXPECT_EQ(group[0].state(), PublishedState::Suspended);
  EXPECT_EQ(outputs.alarm, Alarm::none);
  const Outputs at_two = group.tell(0, 2);
  EXPECT_EQ(at_two.alarm, Alarm::mismatch) << "the halted one raises the halt again";
  group.rounds(2);
  EXPECT_TRUE(group.all_in(PublishedState::Halted)) << group.describe();
  EXPECT_TRUE(group.agreed());
}

TEST(Robust, StartAfterAResetTakesTheBarrierAgain) {
  Group group = started(Variant::robust, 2);
  const std::uint32_t first = group[0].run();
  group.call(0, Method::Suspend);
  group.rounds(2);
  group.call(0, Method::Reset);
  group.tell(0, 1);  // slave 2 has not heard of the reset
  group.drain_journal();
  EXPECT_EQ(group.call(0, Method::Start).status, StatusCode::Good);
  EXPECT_EQ(group[0].run(), first) << "the master does not count as Ready in the new run yet";
  group.tell(0, 1);
  EXPECT_EQ(group[1].state(), PublishedState::Ready);
  EXPECT_EQ(group[1].run(), group[0].intent().run);
  group.tell(1, 0);
  group.tell(0, 1);
  EXPECT_EQ(group.drain_journal(), "") << "nobody runs before slave 2 is Ready in the new run";
  group.tell(0, 2);
  EXPECT_EQ(group.drain_journal(), "2:Halted 2:Halted.INIT ") << "the old run ends, the new one is initialised";
  group.rounds(4);
  EXPECT_TRUE(group.all_in(PublishedState::Running)) << group.describe();
  EXPECT_NE(group[0].run(), first);
  EXPECT_TRUE(group.observer.violations().empty()) << group.describe();
}

TEST(Robust, FinishEndsTheRunForAll) {
  for (std::size_t by = 0; by < 3; ++by) {
    Group group = started(Variant::robust, 2);
    const Outputs outputs = group.step(by, Input::finished());
    EXPECT_TRUE(outputs.process_stopped);
    EXPECT_EQ(outputs.raised_kind, IntentKind::Finish);
    EXPECT_EQ(group[by].machine().last_transition(), 4);
    group.rounds(2);
    EXPECT_TRUE(group.all_in(PublishedState::Ready)) << group.describe();
    EXPECT_TRUE(group.agreed());
    EXPECT_FALSE(group.step(by, Input::finished()).publish) << "only a Running one finishes";
    EXPECT_EQ(group.call(0, Method::Start).status, StatusCode::Good);
    group.rounds(4);
    EXPECT_TRUE(group.all_in(PublishedState::Running)) << group.describe();
  }
}

TEST(Robust, FinishDuringTheBarrierEndsReady) {
  Group group(Variant::robust, 2);
  group.to_barrier();
  group.step(1, Input::finished());
  group.rounds(2);
  EXPECT_TRUE(group.all_in(PublishedState::Ready)) << group.describe();
  EXPECT_TRUE(group.agreed());
}

TEST(Robust, FinishAndSuspendThatMeetEndReady) {
  Group group = started(Variant::robust, 2);
  group.call(1, Method::Suspend);
  group.step(2, Input::finished());
  group.rounds(3);
  EXPECT_TRUE(group.all_in(PublishedState::Ready)) << group.describe();
}

TEST(Robust, OlderWordsOfAnIncarnationAreIgnored) {
  Group group = started(Variant::robust, 1);
  const Message old = group.message(1, 0);
  group.call(1, Method::Suspend);
  group.tell(1, 0);
  const Outputs outputs = group.deliver(old);
  EXPECT_TRUE(outputs.ignored);
  EXPECT_EQ(outputs.arm_timeout, 0U);
  EXPECT_EQ(group[0].state(), PublishedState::Suspended);
}

TEST(Robust, SequenceNumbersWrap) {
  Participant<4> slave({Variant::robust, Role::slave, 1, 1, 1});
  const Word word{7, PublishedState::Halted, {}, 0};
  for (const std::uint16_t sequence : std::initializer_list<std::uint16_t>{0xFFFE, 0xFFFF, 0, 1})
    EXPECT_FALSE(slave.step(Input::received(0, word, sequence)).ignored) << sequence;
  EXPECT_TRUE(slave.step(Input::received(0, word, 0xFFFF)).ignored);
  EXPECT_FALSE(slave.step(Input::received(0, word, 1)).ignored) << "a duplicate is taken again";
  slave.step(Input::peer_silent(0));
  EXPECT_FALSE(slave.step(Input::received(0, word, 0x9000)).ignored) << "after silence any number is the first";
}

TEST(Robust, ARestartedPeerHaltsTheGroup) {
  for (std::size_t who = 0; who < 3; ++who) {
    Group group = started(Variant::robust, 2);
    group.restart(who);
    const std::size_t other = who == 0 ? 1 : 0;
    const Outputs outputs = group.tell(who, other);
    EXPECT_EQ(outputs.alarm, Alarm::peer_restarted);
    EXPECT_TRUE(outputs.process_stopped);
    group.rounds(2);
    EXPECT_TRUE(group.all_in(PublishedState::Halted)) << group.describe();
    EXPECT_TRUE(group.agreed());
    EXPECT_EQ(group.call(0, Method::Start).status, StatusCode::Good);
    group.rounds(4);
    EXPECT_TRUE(group.all_in(PublishedState::Running)) << group.describe();
    EXPECT_TRUE(group.observer.violations().empty());
  }
}

// Found by the random schedules: who takes the incarnation heard last for the newest, and ignores the one before,
// ignores the living one for ever if a late word of the dead one comes in between.
TEST(Robust, ALateWordOfAFormerIncarnationDoesNotShutOutTheNewOne) {
  Group group(Variant::robust, 1);
  const Message late = group.message(1, 0);
  group.restart(1);
  group.tell(1, 0);
  EXPECT_FALSE(group.deliver(late).ignored);
  EXPECT_FALSE(group.tell(1, 0).ignored);
  group.call(0, Method::Start);
  group.rounds(4);
  EXPECT_TRUE(group.all_in(PublishedState::Running)) << group.describe();
  EXPECT_EQ(group.deliver(late).alarm, Alarm::peer_restarted) << "and while Running it costs a halt";
  group.rounds(3);
  EXPECT_TRUE(group.agreed()) << group.describe();
}

// The hole in "a restarted master can adopt its own old start from a slave and wait for ever", mended at both ends.
TEST(Robust, ARestartedMasterDoesNotAdoptItsOldStart) {
  Group group = started(Variant::robust, 2);
  group.restart(0);
  const Outputs outputs = group.tell(1, 0);
  EXPECT_EQ(outputs.alarm, Alarm::mismatch);
  EXPECT_EQ(group[0].intent().kind, IntentKind::Halt);
  group.rounds(2);
  EXPECT_TRUE(group.all_in(PublishedState::Halted)) << group.describe();
}

// Nor while its slaves are still on their way: who has been restarted starts when it is called, and not before.
TEST(Robust, ARestartedMasterDoesNotAdoptAStartThatItsSlavesHaveNotFinished) {
  Group group(Variant::robust, 2);
  group.call(0, Method::Start);
  group.notify_all(0);
  ASSERT_EQ(group[1].state(), PublishedState::HaltedInit);
  group.restart(0);
  const Outputs outputs = group.tell(1, 0);
  EXPECT_EQ(outputs.alarm, Alarm::mismatch);
  EXPECT_EQ(group[0].state(), PublishedState::Halted);
  EXPECT_EQ(group[0].intent().kind, IntentKind::Halt);
}

// Words of the run before must not carry a restarted master, which gives the same number again, through the barrier.
TEST(Robust, StaleWordsDoNotCountInTheRunOfANewIncarnation) {
  Group group(Variant::robust, 1);
  group.call(0, Method::Start);
  group.round();
  group.initialised(1);
  const Message stale_ready = group.message(1, 0);
  group.restart(0);
  group.call(0, Method::Start);
  ASSERT_EQ(group[0].intent().number, stale_ready.word.intent.number);
  group.initialised(0);
  group.deliver(stale_ready);
  EXPECT_EQ(group[0].state(), PublishedState::HaltedInit);
  group.rounds(3);
  EXPECT_TRUE(group.agreed()) << group.describe();
  EXPECT_TRUE(group.all_in(PublishedState::Halted)) << group.describe();
}

// A slave that was restarted within a run must not slip in behind the barrier, even if nobody hears its new
// incarnation.
TEST(Robust, ARestartedSlaveDoesNotJoinARunThatIsPastTheBarrier) {
  Group group = started(Variant::robust, 2);
  group.restart(1);
  const Outputs outputs = group.tell(0, 1);
  EXPECT_EQ(outputs.alarm, Alarm::mismatch);
  EXPECT_EQ(outputs.change_count, 0);
  EXPECT_EQ(group[1].intent().kind, IntentKind::Halt);
}

TEST(Robust, AnIntentOfAnotherRunIsAMismatch) {
  for (const IntentKind kind : {IntentKind::Resume, IntentKind::Suspend, IntentKind::Finish, IntentKind::Reset}) {
    Group group = started(Variant::robust, 1);
    Word word = group[0].word();
    word.state = goal_of(kind);
    word.run = word.run + 1;
    word.intent = {word.intent.number + 1, kind, 0, word.run};
    const Outputs outputs = group.step(1, Input::received(0, word, 1000));
    EXPECT_EQ(outputs.alarm, Alarm::mismatch) << name_of(kind);
    EXPECT_EQ(group[1].state(), PublishedState::Halted);
    EXPECT_EQ(group[1].intent().number, word.intent.number + 1);
  }
}

TEST(Robust, ASilentPeerHaltsWhoeverIsNotHalted) {
  for (std::size_t who = 0; who < 3; ++who) {
    Group group = started(Variant::robust, 2);
    const std::size_t peer = who == 0 ? 1 : 0;
    const Outputs outputs = group.step(who, Input::peer_silent(peer));
    EXPECT_EQ(outputs.alarm, Alarm::peer_silent);
    group.rounds(2);
    EXPECT_TRUE(group.all_in(PublishedState::Halted)) << group.describe();
    EXPECT_FALSE(group.step(who, Input::peer_silent(peer)).publish) << "in Halted silence means nothing";
  }
  Group group(Variant::robust, 2);
  EXPECT_EQ(group.call(0, Method::Start).arm_timeout, 3U) << "time-outs begin to matter with INIT";
  EXPECT_EQ(group.step(0, Input::peer_silent(1)).alarm, Alarm::peer_silent);
}

TEST(Robust, AnOvertakenInitialisationDoesNotCount) {
  Group group(Variant::robust, 1);
  group.call(0, Method::Start);
  const Outputs first = group.tell(0, 1);
  group.call(0, Method::Halt);
  group.call(0, Method::Start);
  const Outputs second = group.tell(0, 1);  // the halt was never heard
  EXPECT_TRUE(second.begin_initialisation);
  EXPECT_NE(first.initialisation_run, second.initialisation_run);
  group.step(1, Input::initialised(first.initialisation_run));
  EXPECT_EQ(group[1].state(), PublishedState::HaltedInit);
  group.step(1, Input::initialised(second.initialisation_run));
  EXPECT_EQ(group[1].state(), PublishedState::Ready);
}

TEST(Robust, ProcessDataCarryingItsRunCountsInThatRunOnly) {
  Group group = started(Variant::robust, 1);
  const std::uint32_t run = group[0].run();
  EXPECT_TRUE(group[1].process_data_counts(0, run));
  EXPECT_FALSE(group[1].process_data_counts(0, run + 1));
  group.call(1, Method::Suspend);
  EXPECT_FALSE(group[1].process_data_counts(0, run));
}

TEST(Robust, HostileWordsDoNoHarm) {
  Group group = started(Variant::robust, 1);
  Word word = group[1].word();
  word.state = static_cast<PublishedState>(99);
  EXPECT_TRUE(group.step(0, Input::received(0, word, 30000)).ignored);
  const auto is_ignored = [&](const Intent& intent, PublishedState state, std::uint32_t run) {
    Word forged = group[1].word();
    forged.intent = intent;
    forged.state = state;
    forged.run = run;
    return group.step(0, Input::received(0, forged, 30000)).ignored;
  };
  const Intent start = group[0].intent();
  const std::uint32_t run = start.run;
  const std::uint32_t number = start.number + 1;
  EXPECT_TRUE(is_ignored({number, static_cast<IntentKind>(6), 0, run}, PublishedState::Halted, 0));
  EXPECT_TRUE(is_ignored({number, IntentKind::Halt, 2, 0}, PublishedState::Halted, 0)) << "origin 2 of 0..1";
  EXPECT_TRUE(is_ignored({number, IntentKind::Halt, 1, run}, PublishedState::Halted, 0)) << "a halt has no run";
  EXPECT_TRUE(is_ignored({number, IntentKind::Halt, 1, 0}, PublishedState::Running, run))
      << "who knows of a halt is Halted";
  EXPECT_TRUE(is_ignored({0, IntentKind::Suspend, 1, run}, PublishedState::Suspended, run)) << "0 is no number";
  EXPECT_TRUE(is_ignored({number, IntentKind::Start, 1, run_of(1, number)}, PublishedState::HaltedInit, 0))
      << "a slave does not start";
  EXPECT_TRUE(is_ignored({number, IntentKind::Start, 0, run}, PublishedState::HaltedInit, 0))
      << "the run is not that of the number";
  EXPECT_TRUE(is_ignored({number, IntentKind::Suspend, 1, run}, PublishedState::Running, run))
      << "who knows of a suspend is Suspended";
  EXPECT_TRUE(is_ignored({number, IntentKind::Suspend, 1, run}, PublishedState::Suspended, run + 1))
      << "suspended in another run";
  EXPECT_TRUE(is_ignored({number, IntentKind::Suspend, 1, 0x10000}, PublishedState::Suspended, 0x10000)) << "no run";
  EXPECT_TRUE(group.all_in(PublishedState::Running));
  EXPECT_FALSE(is_ignored({number, IntentKind::Suspend, 1, run}, PublishedState::Suspended, run));
}

// What was true under the intent before, and cannot be said under the one that stands here: it neither counts as a sign
// of life nor makes the true words look old.
TEST(Robust, TheLastWordUnderAnotherIntentIsNobodys) {
  for (const Method method : {Method::Suspend, Method::Halt}) {
    Group group = started(Variant::robust, 1);
    const Word before = group[1].word();
    group.call(0, method);
    Word damaged = before;
    damaged.intent = group[0].intent();
    const Outputs outputs = group.step(0, Input::received(0, damaged, 30000));
    EXPECT_TRUE(outputs.ignored);
    EXPECT_EQ(outputs.arm_timeout, 0U);
    EXPECT_FALSE(group.tell(1, 0).ignored);
  }
  // Halted, and the other one still in INIT or Halted again.
  Group group(Variant::robust, 1);
  group.call(0, Method::Start);
  group.tell(0, 1);
  group.tell(1, 0);
  Word damaged = group[1].word();
  EXPECT_EQ(damaged.state, PublishedState::HaltedInit);
  group.call(0, Method::Halt);
  damaged.intent = group[0].intent();
  EXPECT_TRUE(group.step(0, Input::received(0, damaged, 30000)).ignored);
  group.tell(0, 1);
  EXPECT_FALSE(group.tell(1, 0).ignored);
}

// The greatest number, far ahead and far away: what a stranger says may halt the group, but it starts again.
TEST(Robust, NoNumberIsTheLast) {
  for (const std::uint32_t number :
       {0xFFFFFFFFU, 0xFFFFFFFEU, 0x40000001U, 0x40000002U, 0x80000000U, 0xC0000001U, 0xC0000002U}) {
    for (const std::size_t victim : {0, 1, 2}) {
      for (const bool is_running : {false, true}) {
        Group group = is_running ? started(Variant::robust, 2) : Group(Variant::robust, 2);
        if (!is_running) group.call(0, Method::Start), group.call(0, Method::Halt), group.rounds(4);
        Message forged = group.message(victim == 0 ? 1 : 0, victim);
        forged.word.state = PublishedState::Halted;
        forged.word.run = 0;
        forged.word.intent = {number, IntentKind::Halt, 1, 0};
        group.deliver(forged);
        group.rounds(8);
        for (std::size_t i = 1; i < 3; ++i) EXPECT_EQ(group[i].intent(), group[0].intent()) << group.describe();
        if (group[0].state() != PublishedState::Running) {
          EXPECT_EQ(group.call(0, Method::Start).status, StatusCode::Good);
        }
        group.rounds(8);
        EXPECT_TRUE(group.all_in(PublishedState::Running)) << number << ": " << group.describe();
      }
    }
  }
}

TEST(Robust, ProgramErrorsAreChecked) {
  using Small = Participant<4>;
  EXPECT_THROW(Small({Variant::robust, Role::master, 0, 5, 1}), sim::InvariantBroken);
  EXPECT_THROW(Small({Variant::robust, Role::master, 1, 2, 1}), sim::InvariantBroken);
  EXPECT_THROW(Small({Variant::robust, Role::slave, 3, 2, 1}), sim::InvariantBroken);
  EXPECT_THROW(Small({Variant::robust, Role::master, 0, 0, 1}), sim::InvariantBroken);
  Small master({Variant::robust, Role::master, 0, 4, 1});
  EXPECT_THROW(master.step(Input::peer_silent(4)), sim::InvariantBroken);
  EXPECT_THROW(master.step(Input::received(4, Word{}, 0)), sim::InvariantBroken);
}

TEST(Participant, SixtyFourSlavesStart) {
  Group group = started(Variant::robust, 64);
  EXPECT_EQ(group[0].peer_count(), 64U);
  EXPECT_EQ(group[64].participant_of(0), 0U);
  EXPECT_EQ(group[0].participant_of(group[0].peer_of(64)), 64U);
  started(Variant::paper, 64);
}

TEST(Participant, EqualValuesHaveEqualHashes) {
  Group one = started(Variant::robust, 3);
  Group other = started(Variant::robust, 3);
  for (std::size_t i = 0; i < one.size(); ++i) {
    EXPECT_TRUE(one[i] == other[i]);
    EXPECT_EQ(one[i].hash(), other[i].hash());
  }
  other.call(1, Method::Suspend);
  EXPECT_FALSE(one[1] == other[1]);
  EXPECT_NE(one[1].hash(), other[1].hash());
  other.tell(1, 0);
  EXPECT_NE(one[0].hash(), other[0].hash());
}

// A group whose slaves have swapped their names does the same under the other names.
TEST(Participant, RenamedDoesTheSameUnderOtherNames) {
  const std::array<std::uint8_t, 4> to{0, 3, 1, 2};
  const std::array<std::uint8_t, 4> back{0, 2, 3, 1};
  for (const Variant variant : {Variant::robust, Variant::paper}) {
    Group one = started(variant, 3);
    Group other = started(variant, 3);
    one.call(1, Method::Suspend);
    other.call(to[1], Method::Suspend);
    for (std::uint8_t i = 1; i <= 3; ++i) {
      one.tell(i, 0);
      other.tell(to[i], 0);
    }
    EXPECT_TRUE(one[0].renamed(to) == other[0]);
    EXPECT_EQ(one[0].renamed(to).hash(), other[0].hash());
    for (std::uint8_t i = 0; i <= 3; ++i) {
      EXPECT_EQ(one[i].renamed(to).config().index, to[i]);
      EXPECT_EQ(one[i].renamed(to).word(), other[to[i]].word()) << int{i};
      EXPECT_TRUE(one[i].renamed(to).renamed(back) == one[i]);
    }
    EXPECT_FALSE(one[0].renamed(to) == one[0]);
  }
}

TEST(Participant, NoStepDependsOnTheLastTransition) {
  Group group = started(Variant::robust, 1);
  auto forgetful = group[0];
  forgetful.forget_last_transition();
  EXPECT_EQ(forgetful.machine().last_transition(), 0);
  EXPECT_FALSE(forgetful == group[0]);
  EXPECT_EQ(forgetful.word(), group[0].word());
  auto mindful = group[0];
  EXPECT_EQ(forgetful.step(Input::command(Method::Suspend)).change[0],
            mindful.step(Input::command(Method::Suspend)).change[0]);
  EXPECT_TRUE(forgetful == mindful);
}

}  // namespace
}  // namespace takt::handshake
