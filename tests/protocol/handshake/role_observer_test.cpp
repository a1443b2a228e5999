// SPDX-License-Identifier: Apache-2.0
// Whose steps are a role's.
#include "handshake/role_observer.hpp"

#include <gtest/gtest.h>

namespace takt::handshake {
namespace {

constexpr Binding a{0, 5};
constexpr Binding b{1, 9};

TEST(RoleObserver, OnlyTheBoundLifeCounts) {
  RoleObserver observer;
  EXPECT_FALSE(observer.on_step(a, PublishedState::Ready));  // nobody has the role
  const auto first = observer.on_bound(a, std::nullopt);
  EXPECT_TRUE(first.is_new && first.is_another);
  EXPECT_EQ(first.gone, std::nullopt);
  EXPECT_FALSE(observer.on_bound(a, std::nullopt).is_new);
  EXPECT_TRUE(observer.on_step(a, PublishedState::Running));
  EXPECT_FALSE(observer.on_step({0, 4}, PublishedState::Halted));  // a former life
  EXPECT_EQ(observer.state(), PublishedState::Running);
  EXPECT_FALSE(observer.counts(b));
}

// Whoever was let go and goes on is nobody's participant; dropping it later changes nothing.
TEST(RoleObserver, AReplacedParticipantIsGone) {
  RoleObserver observer;
  observer.on_bound(a, std::nullopt);
  observer.on_step(a, PublishedState::Running);
  const auto change = observer.on_bound(b, std::nullopt);
  EXPECT_EQ(change.gone, PublishedState::Running);
  EXPECT_TRUE(change.is_another);
  EXPECT_FALSE(observer.on_step(a, PublishedState::Halted));
  EXPECT_EQ(observer.on_dropped(a), std::nullopt);
  EXPECT_EQ(observer.state(), PublishedState::Halted);
  const auto next_life = observer.on_bound({1, 10}, std::nullopt);
  EXPECT_TRUE(next_life.is_new);
  EXPECT_FALSE(next_life.is_another);
  EXPECT_EQ(next_life.gone, PublishedState::Halted);
}

TEST(RoleObserver, ADroppedParticipantWasInItsState) {
  RoleObserver observer;
  observer.on_bound(a, std::nullopt);
  observer.on_step(a, PublishedState::Suspended);
  EXPECT_EQ(observer.on_dropped(a), PublishedState::Suspended);
  EXPECT_EQ(observer.on_bound({}, std::nullopt).gone, PublishedState::Halted);
  EXPECT_FALSE(observer.on_bound(b, std::nullopt).gone);
}

// A restarted master binds a life that is Running in a run of before: it is looked at when it has halted.
TEST(RoleObserver, ALifeOfAFormerRunIsAwaited) {
  RoleObserver observer;
  observer.on_bound(a, PublishedState::Running);
  EXPECT_FALSE(observer.counts(a));
  EXPECT_FALSE(observer.on_step(a, PublishedState::Suspended));
  EXPECT_FALSE(observer.on_step(a, PublishedState::Halted));
  EXPECT_TRUE(observer.counts(a));
  EXPECT_TRUE(observer.on_step(a, PublishedState::HaltedInit));
}

}  // namespace
}  // namespace takt::handshake
