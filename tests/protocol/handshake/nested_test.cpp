// SPDX-License-Identifier: Apache-2.0
// Nested Programs: what each command, halt and crash does in the whole tree.
#include <gtest/gtest.h>

#include "tree.hpp"

namespace takt::handshake {
namespace {

using program::Method;
using program::StatusCode;
using enum PublishedState;

/// Cell (two machines) > machine (two axes) > axis (two drives). Group 1 is nested at cell.1, group 2 at machine.1.
Tree three_levels() { return Tree({{3, 0, 0}, {3, 0, 1}, {3, 1, 1}}); }

Tree started() {
  Tree tree = three_levels();
  EXPECT_EQ(tree.call(0, 0, Method::Start), StatusCode::Good);
  tree.rounds(12);
  EXPECT_TRUE(tree.all_in(Running)) << tree.describe();
  tree.journal.clear();
  return tree;
}

TEST(Nested, StartPassesTheBarriersFromTheInside) {
  Tree tree({{2, 0, 0}, {2, 0, 1}});
  tree.call(0, 0, Method::Start);
  tree.notify_all(0, 0);
  EXPECT_EQ(tree.journal, "0.0:Halted.INIT 0.1:Halted.INIT 1.0:Halted.INIT ");
  tree.journal.clear();
  for (std::size_t number : {0u, 1u, 2u}) tree.initialised(number);
  tree.notify_all(0, 1);
  EXPECT_EQ(tree.member(0, 1).state(), HaltedInit) << "its inner slave is not Ready";
  tree.notify_all(1, 0);
  tree.initialised(3);
  tree.notify_all(1, 1);
  EXPECT_EQ(tree.journal, "1.1:Halted.INIT 1.1:Ready 0.1:Ready ");
  tree.journal.clear();
  tree.notify_all(1, 0);
  EXPECT_EQ(tree.journal, "") << "the inner barrier waits for the outer one";
  tree.notify_all(0, 1);
  tree.notify_all(0, 0);
  EXPECT_EQ(tree.journal, "0.0:Ready 1.0:Ready ") << "the outer Running waits for the inner one";
  tree.journal.clear();
  tree.notify_all(1, 0);
  tree.notify_all(1, 1);
  tree.notify_all(0, 1);
  EXPECT_EQ(tree.journal, "1.1:Running 1.0:Running 0.1:Running 0.0:Running ");
  EXPECT_TRUE(tree.observer.violations().empty()) << tree.describe();
}

TEST(Nested, ThreeLevelsStartAndAreInOneRun) {
  Tree tree = started();
  EXPECT_TRUE(tree.agreed()) << tree.describe();
  EXPECT_TRUE(tree.observer.violations().empty()) << tree.describe();
  ASSERT_EQ(tree.reactions.reactions().size(), 1u);
  EXPECT_EQ(tree.reactions.reactions()[0].outcome, ReactionOutcome::completed);
}

TEST(Nested, AnInnerGroupIsNotStartedFromOutside) {
  Tree tree = three_levels();
  EXPECT_EQ(tree.call(1, 0, Method::Start), StatusCode::BadInvalidState);
  EXPECT_EQ(tree.call(2, 0, Method::Start), StatusCode::BadInvalidState);
  EXPECT_TRUE(tree.all_in(Halted));
}

/// Everybody who may ask, at every level.
class FromAnywhere : public testing::TestWithParam<std::size_t> {};
INSTANTIATE_TEST_SUITE_P(Participants, FromAnywhere, testing::Range<std::size_t>(0, 9));

TEST_P(FromAnywhere, SuspendResumeResetAndHaltReachTheWholeTree) {
  Tree tree = started();
  const auto [group, index] = tree.place(GetParam());
  const std::pair<Method, PublishedState> story[] = {
      {Method::Suspend, Suspended}, {Method::Resume, Running}, {Method::Suspend, Suspended}, {Method::Reset, Ready}};
  for (const auto& [method, state] : story) {
    ASSERT_EQ(tree.call(group, index, method), StatusCode::Good) << tree.describe();
    tree.rounds(4);
    ASSERT_TRUE(tree.all_in(state)) << tree.describe();
    ASSERT_TRUE(tree.agreed()) << tree.describe();
  }
  ASSERT_EQ(tree.call(0, 0, Method::Start), StatusCode::Good);
  tree.rounds(12);
  ASSERT_TRUE(tree.all_in(Running)) << tree.describe();
  ASSERT_EQ(tree.call(group, index, Method::Halt), StatusCode::Good);
  tree.rounds(4);
  EXPECT_TRUE(tree.all_in(Halted)) << tree.describe();
  EXPECT_TRUE(tree.agreed()) << tree.describe();
  EXPECT_TRUE(tree.observer.violations().empty()) << tree.describe();
}

TEST_P(FromAnywhere, WhoeverFinishesTakesAllToReady) {
  Tree tree = started();
  const auto [group, index] = tree.place(GetParam());
  tree.step(group, index, Input::finished());
  tree.rounds(4);
  EXPECT_TRUE(tree.all_in(Ready) && tree.agreed()) << tree.describe();
  ASSERT_EQ(tree.call(0, 0, Method::Start), StatusCode::Good);
  tree.rounds(12);
  EXPECT_TRUE(tree.all_in(Running) && tree.agreed()) << tree.describe();
  EXPECT_TRUE(tree.observer.violations().empty()) << tree.describe();
}

TEST_P(FromAnywhere, WhoeverRestartsHaltsTheWholeTree) {
  Tree tree = started();
  tree.restart(tree.node_of(GetParam()));
  tree.rounds(5);
  EXPECT_TRUE(tree.all_in(Halted)) << tree.describe();
  ASSERT_EQ(tree.call(0, 0, Method::Start), StatusCode::Good);
  tree.rounds(12);
  EXPECT_TRUE(tree.all_in(Running) && tree.agreed()) << tree.describe();
  EXPECT_TRUE(tree.observer.violations().empty()) << tree.describe();
}

TEST(Nested, SilenceInsideHaltsOutsideAndTheOtherWayRound) {
  for (const auto& [group, who, peer] :
       {std::tuple{2u, 0u, 1u}, std::tuple{2u, 2u, 0u}, std::tuple{0u, 0u, 1u}, std::tuple{0u, 2u, 0u}}) {
    Tree tree = started();
    EXPECT_EQ(tree.step(group, who, Input::peer_silent(peer)).alarm, Alarm::peer_silent);
    tree.rounds(4);
    EXPECT_TRUE(tree.all_in(Halted)) << tree.describe();
  }
}

TEST(Nested, ASuspendWithinTheOuterBarrierIsPassedOnWhenThatIsOver) {
  Tree tree({{3, 0, 0}, {2, 0, 1}});
  tree.call(0, 0, Method::Start);
  tree.rounds(1);  // the inner group is Ready, the master of the outer one not yet
  for (int i = 0; i < 20 && tree.member(1, 0).state() != Running; ++i) {
    if (tree.member(0, 0).state() == Ready) tree.notify_all(0, 0);
    tree.notify_all(1, 0);
    tree.notify_all(1, 1);
    if (tree.member(0, 0).state() != Ready) tree.round();
  }
  ASSERT_EQ(tree.member(0, 1).state(), Running) << tree.describe();
  ASSERT_EQ(tree.member(0, 0).state(), Ready) << tree.describe();
  tree.notify_all(1, 0);
  ASSERT_EQ(tree.call(1, 1, Method::Suspend), StatusCode::Good);
  tree.notify_all(1, 1);
  EXPECT_EQ(tree.member(1, 0).state(), Suspended);
  EXPECT_EQ(tree.member(0, 1).state(), Running) << "not before the barrier is over";
  tree.rounds(4);
  EXPECT_TRUE(tree.all_in(Suspended) && tree.agreed()) << tree.describe();
}

/// Cell with a nested machine and a plain slave, which is Running while the machine has not heard that the cell's
/// master is Ready.
Tree within_the_barrier() {
  Tree tree({{3, 0, 0}, {3, 0, 1}});
  tree.call(0, 0, Method::Start);
  tree.notify_all(0, 0);
  for (int i = 0; i < 3; ++i) {
    for (std::size_t n = 0; n < tree.participants(); ++n)
      if (tree.initialising(n)) tree.initialised(n);
    for (std::size_t i2 = 0; i2 < 3; ++i2) tree.notify_all(1, i2);
    tree.notify_all(0, 1);
    tree.notify_all(0, 2);
  }
  EXPECT_EQ(tree.member(0, 0).state(), Ready) << tree.describe();
  EXPECT_EQ(tree.member(0, 1).state(), Ready) << tree.describe();
  EXPECT_EQ(tree.member(1, 0).state(), HaltedInit) << tree.describe();
  tree.deliver(tree.message(0, 0, 2));
  EXPECT_EQ(tree.member(0, 2).state(), Running) << tree.describe();
  return tree;
}

TEST(Nested, AFinishOutsideEndsAnInnerBarrierThatHasNotBegun) {
  Tree tree = within_the_barrier();
  tree.step(0, 2, Input::finished());
  tree.notify_all(0, 2);
  tree.notify_all(0, 0);
  EXPECT_EQ(tree.member(1, 0).state(), Ready) << tree.describe();
  tree.rounds(3);
  EXPECT_TRUE(tree.all_in(Ready) && tree.agreed()) << tree.describe();
  EXPECT_TRUE(tree.observer.violations().empty()) << tree.describe();
}

TEST(Nested, AFinishInsideEndsTheOuterBarrier) {
  Tree tree = within_the_barrier();
  tree.deliver(tree.message(0, 0, 1));
  tree.notify_all(1, 0);
  ASSERT_EQ(tree.member(1, 1).state(), Running) << tree.describe();
  ASSERT_EQ(tree.member(0, 1).state(), Ready) << tree.describe();
  tree.step(1, 1, Input::finished());
  tree.rounds(3);
  EXPECT_TRUE(tree.all_in(Ready) && tree.agreed()) << tree.describe();
  EXPECT_TRUE(tree.observer.violations().empty()) << tree.describe();
}

TEST(Nested, AnInnerResetThatOverrulesTheStartDelaysIt) {
  Tree tree({{2, 0, 0}, {3, 0, 1}});
  tree.call(0, 0, Method::Start);
  tree.rounds(8);
  ASSERT_EQ(tree.call(0, 0, Method::Suspend), StatusCode::Good);
  tree.rounds(4);
  ASSERT_TRUE(tree.all_in(Suspended)) << tree.describe();
  // Both ends reset at the same time; the later words of the inner slave meet a start with its number.
  ASSERT_EQ(tree.call(1, 2, Method::Reset), StatusCode::Good);
  ASSERT_EQ(tree.call(0, 1, Method::Reset), StatusCode::Good);
  const TreeMessage late = tree.message(1, 2, 0);
  tree.notify_all(0, 1);
  ASSERT_EQ(tree.call(0, 0, Method::Start), StatusCode::Good) << tree.describe();
  tree.notify_all(0, 0);
  tree.deliver(late);
  tree.rounds(8);
  EXPECT_TRUE(tree.all_in(Running) && tree.agreed()) << tree.describe();
  EXPECT_TRUE(tree.observer.violations().empty()) << tree.describe();
}

/// Found by the explorer: an inner slave has reset by itself, the node has finished, and the outer group starts anew.
TEST(Nested, AnOverruledInnerStartIsRepeated) {
  Tree tree({{2, 0, 0}, {2, 0, 1}});
  tree.call(0, 0, Method::Start);
  tree.rounds(8);
  ASSERT_TRUE(tree.all_in(Running)) << tree.describe();
  ASSERT_EQ(tree.call(1, 1, Method::Suspend), StatusCode::Good);
  ASSERT_EQ(tree.call(1, 1, Method::Reset), StatusCode::Good);
  const TreeMessage late = tree.message(1, 1, 0);
  tree.step(0, 1, Input::finished());
  tree.notify_all(0, 1);
  ASSERT_EQ(tree.call(0, 0, Method::Start), StatusCode::Good) << tree.describe();
  tree.notify_all(0, 0);
  tree.deliver(late);
  EXPECT_EQ(tree.member(1, 0).intent().kind, IntentKind::Start) << tree.describe();
  tree.rounds(8);
  EXPECT_TRUE(tree.all_in(Running) && tree.agreed()) << tree.describe();
  EXPECT_TRUE(tree.observer.violations().empty()) << tree.describe();
}

/// A node is prepared when its inner slaves are Ready and its own two initialisations have ended, those of this run.
TEST(Nested, ANodeIsNotReadyBeforeItHasInitialisedBothItsSides) {
  for (const bool again : {false, true})
    for (const std::size_t slower : {1u, 2u}) {
      SCOPED_TRACE(testing::Message() << "side " << slower << (again ? " in the second run" : ""));
      Tree tree({{2, 0, 0}, {2, 0, 1}});
      if (again) {
        tree.call(0, 0, Method::Start);
        tree.rounds(8);
        tree.call(0, 0, Method::Halt);
        tree.rounds(4);
      }
      tree.call(0, 0, Method::Start);
      for (int i = 0; i < 4; ++i) {
        for (std::size_t number = 0; number < tree.participants(); ++number)
          if (number != slower && tree.initialising(number)) tree.initialised(number);
        for (std::size_t group : {0u, 1u})
          for (std::size_t index : {0u, 1u}) tree.notify_all(group, index);
      }
      ASSERT_EQ(tree.member(1, 1).state(), Ready) << tree.describe();
      EXPECT_EQ(tree.member(0, 1).state(), HaltedInit) << tree.describe();
      tree.initialised(slower);
      EXPECT_EQ(tree.member(0, 1).state(), Ready) << tree.describe();
    }
}

TEST(Nested, TheValueIsCopiedComparedAndHashed) {
  const Config outer{Variant::robust, Role::slave, 1, 1, 1, Subscription::star, false};
  const Config inner{Variant::robust, Role::master, 0, 1, 1, Subscription::star, false};
  NestedParticipant<4, 4> a(outer, inner);
  NestedParticipant<4, 4> b = a;
  EXPECT_EQ(a, b);
  EXPECT_EQ(a.hash(), b.hash());
  b.step(Side::outer, Input::received(0, {1, HaltedInit, {1, IntentKind::Start, 0, run_of(1, 1)}, 0}, 1));
  EXPECT_EQ(b.inner().state(), HaltedInit);
  EXPECT_NE(a, b);
  EXPECT_NE(a.hash(), b.hash());
}

}  // namespace
}  // namespace takt::handshake
