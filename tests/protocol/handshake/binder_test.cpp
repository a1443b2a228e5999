// SPDX-License-Identifier: Apache-2.0
// Who gets which role, and what becomes of the group when somebody comes or goes.
#include <gtest/gtest.h>

#include "roles.hpp"

namespace takt::handshake {
namespace {

using program::Method;
using program::StatusCode;
using enum PublishedState;

constexpr SkillId weld = 1;
constexpr SkillId grip = 2;

std::uint8_t candidate_of(const RoleGroup& group, std::size_t role) { return group.binder().binding(role).candidate; }

RoleGroup running(RoleGroup group, std::initializer_list<std::size_t> joined) {
  for (const std::size_t c : joined) group.join(c);
  group.rounds(2);
  EXPECT_EQ(group.call(0, Method::Start), StatusCode::Good) << group.describe();
  group.rounds(6);
  EXPECT_TRUE(group.all_in(Running)) << group.describe();
  return group;
}

TEST(Roles, WhoAnnouncesASkillGetsTheRole) {
  RoleGroup group({weld, grip}, {{grip}, {weld}, {weld, grip}});
  EXPECT_EQ(group.call(0, Method::Start), StatusCode::BadInvalidState) << "nobody has a role";
  group.join(0);
  group.rounds(2);
  EXPECT_EQ(candidate_of(group, 1), 0);
  EXPECT_FALSE(group.binder().binding(0).bound());
  EXPECT_EQ(group.call(0, Method::Start), StatusCode::BadInvalidState);
  group.join(1);
  group.rounds(2);
  EXPECT_EQ(candidate_of(group, 0), 1);
  EXPECT_EQ(group.call(0, Method::Start), StatusCode::Good);
  group.rounds(6);
  EXPECT_TRUE(group.all_in(Running)) << group.describe();
}

TEST(Roles, OneIsMovedIfThatFillsOneMoreRole) {
  RoleGroup group({weld, grip}, {{weld, grip}, {weld}});
  group.join(0);
  group.rounds(2);
  EXPECT_EQ(candidate_of(group, 0), 0) << "the first role, for want of others";
  group.join(1);
  group.rounds(4);
  EXPECT_EQ(candidate_of(group, 0), 1);
  EXPECT_EQ(candidate_of(group, 1), 0);
  EXPECT_EQ(group.call(0, Method::Start), StatusCode::Good);
  group.rounds(6);
  EXPECT_TRUE(group.all_in(Running)) << group.describe();
}

TEST(Roles, ALateJoinerIsASpareWhileTheGroupRuns) {
  RoleGroup group = running(RoleGroup({weld}, {{weld}, {weld}}), {0});
  group.join(1);
  group.rounds(3);
  EXPECT_TRUE(group.all_in(Running)) << "nobody stops for it";
  EXPECT_FALSE(group.member(1)) << "and it has no role";
  EXPECT_TRUE(group.binder().present(1));
}

TEST(Roles, ASpareReplacesTheSilentOneAndTheOperatorStarts) {
  RoleGroup group = running(RoleGroup({weld, grip}, {{weld}, {grip}, {weld}}), {0, 1, 2});
  group.silent(0, 0);
  group.rounds(4, 1);
  EXPECT_EQ(candidate_of(group, 0), 2) << group.describe();
  EXPECT_TRUE(group.all_in(Halted)) << group.describe();
  EXPECT_EQ(group.call(0, Method::Start), StatusCode::Good);
  group.rounds(6, 1);
  EXPECT_TRUE(group.all_in(Running)) << group.describe();
  // The one that was silent comes back: it drops its role and is a spare.
  group.rounds(3);
  EXPECT_FALSE(group.member(0));
  EXPECT_TRUE(group.binder().present(0)) << group.describe();
  EXPECT_TRUE(group.all_in(Running) && group.observer.violations().empty()) << group.describe();
}

TEST(Roles, OnReplacementItStartsAgainByItself) {
  RoleGroup group = running(RoleGroup({weld, grip}, {{weld}, {grip}, {weld}}, true), {0, 1, 2});
  group.silent(0, 0);
  group.rounds(10, 1);
  EXPECT_TRUE(group.all_in(Running)) << group.describe();
  EXPECT_EQ(candidate_of(group, 0), 2);
  EXPECT_TRUE(group.observer.violations().empty()) << group.describe();
}

TEST(Roles, ButNotWithoutASpareNorAfterAHalt) {
  RoleGroup group = running(RoleGroup({weld}, {{weld}, {weld}}, true), {0});
  group.silent(0, 0);
  group.rounds(6, 1);
  EXPECT_EQ(group.master().state(), Halted);
  EXPECT_FALSE(group.binder().complete());
  EXPECT_EQ(group.call(0, Method::Halt), StatusCode::BadInvalidState) << "Halted already; but the operator has said so";
  group.join(1);
  group.rounds(10, 1);
  EXPECT_TRUE(group.all_in(Halted)) << group.describe();
}

TEST(Roles, ALeaverIsLetGoThroughAHalt) {
  RoleGroup group = running(RoleGroup({weld}, {{weld}, {weld}}, true), {0, 1});
  group.leave(0);
  group.rounds(10);
  EXPECT_EQ(candidate_of(group, 0), 1);
  EXPECT_FALSE(group.member(0));
  EXPECT_FALSE(group.candidate(0).announces());
  EXPECT_TRUE(group.all_in(Running)) << group.describe();
  group.join(0);
  group.rounds(3);
  EXPECT_TRUE(group.binder().present(0)) << "it may come back as a spare";
}

TEST(Roles, ARestartedNodeIsBoundAgain) {
  RoleGroup group = running(RoleGroup({weld}, {{weld}}), {0});
  group.restart(1);
  group.rounds(6);
  EXPECT_TRUE(group.all_in(Halted)) << group.describe();
  EXPECT_EQ(group.call(0, Method::Start), StatusCode::Good);
  group.rounds(6);
  EXPECT_TRUE(group.all_in(Running) && group.observer.violations().empty()) << group.describe();
}

TEST(Roles, ARestartedMasterFindsItsNodesAgain) {
  RoleGroup group = running(RoleGroup({weld, grip}, {{weld}, {grip}}), {0, 1});
  group.restart(0);
  group.rounds(6);
  EXPECT_TRUE(group.all_in(Halted)) << group.describe();
  EXPECT_EQ(group.call(0, Method::Start), StatusCode::Good);
  group.rounds(6);
  EXPECT_TRUE(group.all_in(Running) && group.observer.violations().empty()) << group.describe();
}

TEST(Roles, WordsOfOneThatWasLetGoCountNothing) {
  RoleGroup group = running(RoleGroup({weld}, {{weld}, {weld}}), {0, 1});
  const std::vector<RoleMessage> late = group.messages(1);
  group.silent(0, 0);
  group.rounds(4, 1);
  ASSERT_EQ(group.call(0, Method::Start), StatusCode::Good) << group.describe();
  group.rounds(6, 1);
  ASSERT_TRUE(group.all_in(Running)) << group.describe();
  for (const RoleMessage& message : late) group.deliver(message);
  EXPECT_TRUE(group.all_in(Running)) << group.describe();
}

}  // namespace
}  // namespace takt::handshake
