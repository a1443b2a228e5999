// SPDX-License-Identifier: Apache-2.0
// PubSubState (OPC 10000-14, 6.2.1): every way from state to state.
#include <gtest/gtest.h>

#include "pubsub/pubsub_state.hpp"

namespace takt::pubsub {
namespace {

TEST(PubSubStates, AReaderStartsUp) {
  PubSubComponent reader(true);
  EXPECT_EQ(reader.state(), PubSubState::PreOperational);
  reader.start();
  EXPECT_EQ(reader.state(), PubSubState::Operational);
  reader.fail(StatusCode::BadTimeout);
  EXPECT_EQ(reader.state(), PubSubState::Error);
  EXPECT_TRUE(reader.active()) << "it still listens";
  reader.recover();
  EXPECT_EQ(reader.state(), PubSubState::Operational);
}

TEST(PubSubStates, ChildrenFollowTheirParent) {
  PubSubComponent child;
  EXPECT_EQ(child.state(), PubSubState::Operational);
  for (const auto parent :
       {PubSubState::Disabled, PubSubState::Paused, PubSubState::Error, PubSubState::PreOperational}) {
    child.set_parent(parent);
    EXPECT_EQ(child.state(), PubSubState::Paused) << name_of(parent);
  }
  child.set_parent(PubSubState::Operational);
  EXPECT_EQ(child.state(), PubSubState::Operational);
  EXPECT_EQ(child.disable(), StatusCode::Good);
  child.set_parent(PubSubState::Paused);
  EXPECT_EQ(child.state(), PubSubState::Disabled) << "stronger than the parent";
  EXPECT_EQ(child.enable(), StatusCode::Good);
  EXPECT_EQ(child.state(), PubSubState::Paused);
}

TEST(PubSubStates, AnErrorEndsWithDisableOrAPause) {
  PubSubComponent reader(true);
  reader.start();
  reader.fail(StatusCode::BadTimeout);
  reader.set_parent(PubSubState::Paused);
  reader.set_parent(PubSubState::Operational);
  EXPECT_EQ(reader.state(), PubSubState::PreOperational);
  reader.fail(StatusCode::BadTimeout);
  reader.disable();
  reader.enable();
  EXPECT_EQ(reader.state(), PubSubState::PreOperational);
  EXPECT_EQ(reader.failure(), StatusCode::Good);
}

}  // namespace
}  // namespace takt::pubsub
