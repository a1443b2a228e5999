// SPDX-License-Identifier: Apache-2.0
// The store of states: nothing is lost and nothing is found twice, however it grows.
#include <gtest/gtest.h>

#include "explore/search/state_store.hpp"

namespace takt::explore {
namespace {

Shape star(std::uint8_t slaves) {
  Query query;
  query.slaves = slaves;
  return Shape(query, Wiring(query).size());
}

State state_number(std::uint8_t slaves, std::uint32_t number) {
  State state(star(slaves));
  state.set_member(0, number);
  state.set_observer(number * 7);
  state.set_reg(1, static_cast<WordId>(number));
  return state;
}

TEST(StateStore, FindsEveryStateAgain) {
  StateStore store(star(3), 1'000'000);
  constexpr std::uint32_t count = 200'000;
  for (std::uint32_t i = 0; i < count; ++i) {
    const State state = state_number(3, i);
    const StateStore::Inserted inserted = store.insert(state, state.hash(), i / 2);
    ASSERT_TRUE(inserted.is_new);
    ASSERT_EQ(inserted.position, i);
  }
  for (std::uint32_t i = 0; i < count; ++i) {
    const State state = state_number(3, i);
    ASSERT_FALSE(store.insert(state, state.hash(), 0).is_new);
    ASSERT_EQ(store.find(state, state.hash()), i);
    ASSERT_EQ(store[i], state);
    ASSERT_EQ(store.parent(i), i / 2);
  }
  const State other = state_number(3, count);
  EXPECT_EQ(store.find(other, other.hash()), StateStore::nowhere);
  EXPECT_EQ(store.size(), count);
}

TEST(StateStore, HasALimit) {
  StateStore store(star(1), 2);
  for (std::uint32_t i = 0; i < 2; ++i)
    store.insert(state_number(1, i), state_number(1, i).hash(), StateStore::nowhere);
  EXPECT_TRUE(store.is_full());
  const State third = state_number(1, 2);
  EXPECT_EQ(store.insert(third, third.hash(), 0).position, StateStore::nowhere);
  EXPECT_EQ(store.size(), 2U);
}

// 64 octets a stored state for three slaves: 40 for the state, 4 for the way to it, and its share of the table.
TEST(StateStore, IsSmall) {
  StateStore store(star(3), 10'000'000);
  for (std::uint32_t i = 0; i < 3'000'000; ++i) store.insert(state_number(3, i), state_number(3, i).hash(), 0);
  EXPECT_LE(store.memory(), 64U * store.size());
}

TEST(State, FieldsDoNotTouchEachOther) {
  State state(star(2));
  for (std::size_t c = 0; c < 4; ++c) state.set_reg(c, static_cast<WordId>(0xFF00U + c));
  state.set_late(Late::overtaken, 3, 0xABCD);
  state.set_commands_left(12);
  state.set_faults_left(7);
  state.set_outdated(State::late_data, true);
  state.set_reg(2, 5);
  EXPECT_EQ(state.reg(1), 0xFF01);
  EXPECT_EQ(state.reg(2), 5);
  EXPECT_EQ(state.reg(3), 0xFF03);
  EXPECT_EQ(state.late(), Late::overtaken);
  EXPECT_EQ(state.late_channel(), 3U);
  EXPECT_EQ(state.late_word(), 0xABCD);
  EXPECT_EQ(state.commands_left(), 12U);
  EXPECT_EQ(state.faults_left(), 7U);
  EXPECT_TRUE(state.outdated(State::late_data));
  EXPECT_FALSE(state.outdated(3));
}

}  // namespace
}  // namespace takt::explore
