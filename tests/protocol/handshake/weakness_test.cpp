// SPDX-License-Identifier: Apache-2.0
// Known weaknesses of `paper`: findings to show, not bugs to mend. Each is pinned here; `robust` does better.
#include <gtest/gtest.h>

#include "group.hpp"

namespace takt::handshake {
namespace {

using program::Method;

bool found(const Group& group, Invariant invariant) {
  for (const Violation& violation : group.observer.violations())
    if (violation.invariant == invariant) return true;
  return false;
}

// The master resumes and at once suspends again; its two words and the slave's answers chase each other for ever.
TEST(PaperWeakness, SuspendAndResumeThatCrossChaseEachOther) {
  Group group = started(Variant::paper, 1);
  group.call(0, Method::Suspend);
  group.round();
  ASSERT_TRUE(group.all_in(PublishedState::Suspended));
  group.call(0, Method::Resume);
  Message to_slave = group.message(0, 1);
  Message to_master = group.message(1, 0);
  group.call(0, Method::Suspend);
  group.drain_journal();
  // Both receive, then publish in each cycle, and what they publish arrives in the next one: nothing is lost, late or
  // out of order.
  for (int cycle = 0; cycle < 100; ++cycle) {
    group.deliver(to_slave);
    group.deliver(to_master);
    to_slave = group.message(0, 1);
    to_master = group.message(1, 0);
    EXPECT_NE(group[0].state(), group[1].state()) << "they never agree";
  }
  const std::string journal = group.drain_journal();
  EXPECT_EQ(journal.substr(0, 66), "1:Running 1:Suspended 0:Running 1:Running 0:Suspended 1:Suspended ");
  EXPECT_GT(journal.size(), 1900U) << "and never rest";
}

// Fig. 6b: the slave resets and is Ready; the master follows, and its Ready looks to the slave like Fig. 3 (4).
TEST(PaperWeakness, ReadyAfterAResetLooksLikeReadyBeforeAStart) {
  Group group = started(Variant::paper, 1);
  group.call(0, Method::Suspend);
  group.round();
  group.call(1, Method::Reset);
  group.drain_journal();
  group.tell(1, 0);
  EXPECT_EQ(group.drain_journal(), "0:Ready ") << "Fig. 6b (3b)";
  group.tell(0, 1);
  EXPECT_EQ(group.drain_journal(), "1:Running ") << "nobody has started anything";
  group.tell(1, 0);
  EXPECT_TRUE(group.all_in(PublishedState::Running));
}

TEST(PaperWeakness, AfterAResetOneRunsBeforeAllAreReady) {
  Group group = started(Variant::paper, 2);
  group.call(0, Method::Suspend);
  group.round();
  group.call(1, Method::Reset);
  group.tell(1, 0);
  group.tell(0, 1);  // slave 2 is still Suspended
  EXPECT_EQ(group[1].state(), PublishedState::Running);
  EXPECT_EQ(group[2].state(), PublishedState::Suspended);
  EXPECT_TRUE(found(group, Invariant::S1)) << group.describe();
}

// The method Start in Ready is Part 10's transition 2: the master does not wait for anybody.
TEST(PaperWeakness, StartAfterAResetRunsTheMasterFirst) {
  Group group = started(Variant::paper, 2);
  group.call(0, Method::Suspend);
  group.round();
  group.call(0, Method::Reset);
  group.round();
  ASSERT_TRUE(group.all_in(PublishedState::Ready));
  group.call(0, Method::Start);
  EXPECT_TRUE(found(group, Invariant::S2)) << group.describe();
}

// States are sampled: halted and started again between two samples, slave 2 never hears of the halt. "In order to
// restart a program, the initialisation phase must be repeated" (III.B), but slave 2 runs without.
TEST(PaperWeakness, AMissedHaltLeavesAStaleReady) {
  Group group(Variant::paper, 2);
  group.call(0, Method::Start);
  group.notify_all(0);
  for (std::size_t i = 0; i < 3; ++i) group.initialised(i);
  group.tell(1, 0);
  group.tell(2, 0);
  ASSERT_EQ(group[0].state(), PublishedState::Ready);
  group.call(0, Method::Halt);
  group.tell(0, 1);  // lost on the way to slave 2
  group.tell(1, 0);
  group.call(0, Method::Start);
  group.drain_journal();
  group.notify_all(0);
  group.initialised(0);
  group.initialised(1);
  group.tell(1, 0);
  group.notify_all(0);
  group.tell(1, 0);
  group.tell(2, 0);
  EXPECT_EQ(group.drain_journal(), "1:Halted.INIT 1:Ready 0:Ready 1:Running 2:Running 0:Running ");
}

// The Ready that the master heard in the first start counts in the second one, while the slaves are still in INIT.
TEST(PaperWeakness, AStaleReadyOpensTheBarrier) {
  Group group(Variant::paper, 2);
  group.call(0, Method::Start);
  group.notify_all(0);
  for (std::size_t i = 0; i < 3; ++i) group.initialised(i);
  group.tell(1, 0);
  group.tell(2, 0);
  group.call(0, Method::Halt);
  group.notify_all(0);
  group.call(0, Method::Start);  // before the slaves' Halted is heard
  group.notify_all(0);
  group.initialised(0);
  EXPECT_EQ(group[0].state(), PublishedState::Ready);
  EXPECT_EQ(group[1].state(), PublishedState::HaltedInit);
  group.initialised(2);
  group.tell(0, 2);
  EXPECT_EQ(group[2].state(), PublishedState::Running);
  EXPECT_TRUE(found(group, Invariant::S1)) << group.describe();
}

// A slave that is halted before its INIT was ever heard looks as if nothing had happened, and the master waits for
// ever.
TEST(PaperWeakness, AHaltBetweenTwoSamplesIsNotHeard) {
  Group group(Variant::paper, 1);
  group.tell(1, 0);
  group.call(0, Method::Start);
  group.tell(0, 1);
  group.call(1, Method::Halt);
  group.rounds(10);
  EXPECT_EQ(group[0].state(), PublishedState::HaltedInit);
  EXPECT_EQ(group[1].state(), PublishedState::Halted);
}

TEST(PaperWeakness, SilenceIsNotNoticed) {
  Group group = started(Variant::paper, 1);
  EXPECT_EQ(group.step(0, Input::peer_silent(0)).change_count, 0);
  EXPECT_EQ(group[0].state(), PublishedState::Running);
}

TEST(PaperWeakness, AFinishIsNotFollowed) {
  Group group = started(Variant::paper, 1);
  group.step(1, Input::finished());
  group.rounds(3);
  EXPECT_EQ(group[0].state(), PublishedState::Running);
  EXPECT_EQ(group[1].state(), PublishedState::Ready);
}

// Not a weakness but the paper's own way: everybody is started from outside, in any order.
TEST(Paper, EverybodyMayBeStartedFromOutside) {
  for (std::size_t first = 0; first < 3; ++first) {
    Group group(Variant::paper, 2);
    for (std::size_t i = 0; i < 3; ++i) {
      const std::size_t who = (first + i) % 3;
      group.notify_all(0);
      if (group[who].state() == PublishedState::Halted) {
        EXPECT_EQ(group.call(who, Method::Start).status, program::StatusCode::Good);
      }
      group.notify_all(who);
    }
    group.rounds(5);
    EXPECT_TRUE(group.all_in(PublishedState::Running)) << first << "\n" << group.describe();
    EXPECT_TRUE(group.observer.violations().empty()) << group.describe();
  }
}

}  // namespace
}  // namespace takt::handshake
