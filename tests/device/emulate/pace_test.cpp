// SPDX-License-Identifier: Apache-2.0
// When an emulation is as far as the simulated run.
#include "emulate/pace.hpp"

#include <gtest/gtest.h>

namespace takt::emulate::pace_test {
namespace {

using handshake::PublishedState;
using handshake::StateChange;

constexpr StateChange init{0, PublishedState::Halted, PublishedState::HaltedInit};
constexpr StateChange ready{1, PublishedState::HaltedInit, PublishedState::Ready};
constexpr StateChange crash{0, PublishedState::Ready, PublishedState::Halted};

sim::Duration at(std::int64_t ps) { return sim::Duration::from_ps(ps); }

const History simulated = {{{10, 0, init}, {12, 1, init}, {20, 1, ready}, {30, 0, ready}, {40, 1, crash}},
                           {{10, 0, program::Method::Start}}};

TEST(Pace, WaitsForEachParticipantsChangesBeforeTheInstant) {
  const Pace pace({simulated});
  History emulated;
  EXPECT_TRUE(pace.is_reached({emulated}, at(10))) << "what happens at the instant is not waited for";
  EXPECT_FALSE(pace.is_reached({emulated}, at(11)));
  emulated.changes = {{5'000, 0, init}};
  EXPECT_TRUE(pace.is_reached({emulated}, at(11)));
  EXPECT_FALSE(pace.is_reached({emulated}, at(13)));
  emulated.changes.push_back({5'001, 0, ready});
  EXPECT_FALSE(pace.is_reached({emulated}, at(13))) << "one participant does not stand for another";
  emulated.changes.push_back({5'002, 1, init});
  EXPECT_TRUE(pace.is_reached({emulated}, at(20)));
}

TEST(Pace, ACrashIsNotWaitedFor) {
  const Pace pace({simulated});
  const History emulated = {{{1, 0, init}, {2, 1, init}, {3, 1, ready}, {4, 0, ready}}, {}};
  EXPECT_TRUE(pace.is_reached({emulated}, at(50)));
}

TEST(Pace, EveryProgramCounts) {
  const Pace pace({History(), simulated});
  EXPECT_FALSE(pace.is_reached({simulated, History()}, at(50)));
  EXPECT_TRUE(pace.is_reached({History(), simulated}, at(50)));
}

TEST(Pace, KnowsWhichCallsWereGood) {
  const Pace pace({simulated});
  EXPECT_TRUE(pace.is_good(0, 0, program::Method::Start, at(10)));
  EXPECT_FALSE(pace.is_good(0, 1, program::Method::Start, at(10)));
  EXPECT_FALSE(pace.is_good(0, 0, program::Method::Halt, at(10)));
  EXPECT_FALSE(pace.is_good(0, 0, program::Method::Start, at(11)));
}

}  // namespace
}  // namespace takt::emulate::pace_test
