// SPDX-License-Identifier: Apache-2.0
// Every method in every state, at the master and at a slave, in both variants.
#include <gtest/gtest.h>

#include <array>

#include "group.hpp"

namespace takt::handshake {
namespace {

using program::Method;
using program::StatusCode;

/// A group of one slave in which both are in a state.
Group group_in(Variant variant, PublishedState state) {
  if (state == PublishedState::Halted) return Group(variant, 1);
  if (state == PublishedState::HaltedInit) {
    Group group(variant, 1);
    group.call(0, Method::Start);
    group.tell(0, 1);
    return group;
  }
  Group group = started(variant, 1);
  if (state == PublishedState::Suspended || state == PublishedState::Ready) {
    group.call(0, Method::Suspend);
    group.round();
  }
  if (state == PublishedState::Ready) {
    group.call(0, Method::Reset);
    group.round();
  }
  return group;
}

using Expected = std::array<std::array<char, 5>, published_state_count>;
constexpr char no = '-';

// Rows: Halted, Ready (after a reset), Running, Suspended, INIT. Columns: Start Suspend Resume Halt Reset.
// Entries: the state after it (H I Y=Ready R S), '-' for Bad_InvalidState.
constexpr Expected paper_both{{{'I', no, no, no, no},
                               {'R', no, no, 'H', no},
                               {no, 'S', no, 'H', no},
                               {no, no, 'R', 'H', 'Y'},
                               {no, no, no, 'H', no}}};
constexpr Expected robust_master{{{'I', no, no, no, no},
                                  {'Y', no, no, 'H', no},
                                  {no, 'S', no, 'H', no},
                                  {no, no, 'R', 'H', 'Y'},
                                  {no, no, no, 'H', no}}};
constexpr Expected robust_slave{{{no, no, no, no, no},
                                 {no, no, no, 'H', no},
                                 {no, 'S', no, 'H', no},
                                 {no, no, 'R', 'H', 'Y'},
                                 {no, no, no, 'H', no}}};

char letter(PublishedState state) { return "HYRSI"[index_of(state)]; }

void check(Variant variant, std::size_t at, const Expected& expected) {
  for (std::size_t s = 0; s < published_state_count; ++s) {
    const PublishedState state = published_state_at(s);
    for (const program::MethodInfo& method : program::methods) {
      SCOPED_TRACE(std::string(name_of(state)) + " " + std::string(method.name) + " at " + std::to_string(at));
      Group group = group_in(variant, state);
      ASSERT_EQ(group[at].state(), state);
      const Group::Member before = group[at];
      const Outputs outputs = group.call(at, method.method);
      const char target = expected[s][program::index_of(method.method)];
      if (target == no) {
        EXPECT_EQ(outputs.status, StatusCode::BadInvalidState);
        EXPECT_TRUE(group[at] == before) << "a refused call changes nothing";
        EXPECT_FALSE(outputs.publish || outputs.raised);
        EXPECT_EQ(outputs.change_count, 0);
      } else {
        EXPECT_EQ(outputs.status, StatusCode::Good);
        EXPECT_EQ(letter(group[at].state()), target);
        EXPECT_TRUE(outputs.publish);
        EXPECT_TRUE(outputs.raised);
        EXPECT_EQ(outputs.raised_kind, kind_of(method.method));
      }
    }
  }
}

TEST(Commands, PaperMaster) { check(Variant::paper, 0, paper_both); }
TEST(Commands, PaperSlave) { check(Variant::paper, 1, paper_both); }
TEST(Commands, RobustMaster) { check(Variant::robust, 0, robust_master); }
TEST(Commands, RobustSlave) { check(Variant::robust, 1, robust_slave); }

TEST(Commands, RobustStartIsRefusedInTheBarrier) {
  Group group(Variant::robust, 1);
  group.to_barrier();
  EXPECT_EQ(group.call(0, Method::Start).status, StatusCode::BadInvalidState);
}

TEST(Commands, RobustSlaveSuspendsOnlyAfterTheBarrier) {
  Group group(Variant::robust, 2);
  group.to_barrier();
  EXPECT_EQ(group.call(1, Method::Suspend).status, StatusCode::BadInvalidState);
  group.rounds(2);
  EXPECT_EQ(group.call(1, Method::Suspend).status, StatusCode::Good);
  EXPECT_EQ(group.call(1, Method::Resume).status, StatusCode::Good);
  group.tell(1, 0);
  EXPECT_EQ(group.call(1, Method::Suspend).status, StatusCode::Good);
  group.tell(1, 0);
  group.tell(0, 1);
  ASSERT_EQ(group[0].state(), PublishedState::Suspended);
  EXPECT_EQ(group.call(1, Method::Resume).status, StatusCode::Good);
  EXPECT_EQ(group.call(1, Method::Suspend).status, StatusCode::Good)
      << "a master that is known Suspended in this run is past the barrier too";
}

}  // namespace
}  // namespace takt::handshake
