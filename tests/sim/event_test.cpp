// SPDX-License-Identifier: Apache-2.0
#include "sim/event.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <tuple>
#include <vector>

#include "sim/random.hpp"

namespace takt::sim {
namespace {

struct Key {
  std::int64_t time;
  Phase phase;
  std::uint32_t node;
  std::uint32_t source;
  std::uint64_t serial;
  /// Control comes before all nodes, judgement behind them.
  int stage() const { return phase == Phase::control ? 0 : phase == Phase::judgement ? 2 : 1; }
  auto tuple() const { return std::tuple(time, stage(), node, phase, source, serial); }
};

Event event_of(const Key& key, EventKind kind = 0) {
  return {TrueTime::from_ps(key.time), Event::order_of(key.phase, {key.node}, {key.source}), key.serial << 16 | kind,
          0};
}

TEST(EventOrder, EachKeyDecidesAndEarlierKeysWin) {
  // Each key is smaller than its successor although all later fields are larger.
  const Key ascending[] = {
      {1, Phase::judgement, 9, 9, 9}, {2, Phase::control, 9, 9, 9}, {2, Phase::timer, 7, 9, 9},
      {2, Phase::arrival, 8, 9, 9},   {2, Phase::arrival, 9, 1, 9}, {2, Phase::arrival, 9, 2, 1},
      {2, Phase::arrival, 9, 2, 2},   {2, Phase::timer, 9, 0, 0},   {2, Phase::decision, 9, 0, 0},
      {2, Phase::judgement, 0, 0, 0}, {3, Phase::control, 0, 0, 0},
  };
  for (std::size_t i = 0; i < std::size(ascending); ++i) {
    for (std::size_t j = 0; j < std::size(ascending); ++j)
      EXPECT_EQ(event_of(ascending[i]) < event_of(ascending[j]), i < j) << i << " and " << j;
  }
}

TEST(EventOrder, IsThatOfTheTupleForRandomKeys) {
  RandomStream chance(7, "event_test", "keys");
  std::vector<Key> keys;
  constexpr std::uint32_t ids[] = {0, 1, 2, max_components - 2, max_components - 1};
  constexpr std::int64_t times[] = {0, 1, 1'000'000'007, INT64_MAX - 1};
  for (int i = 0; i < 400; ++i)
    keys.push_back({times[chance.below(4)], static_cast<Phase>(chance.below(5)), ids[chance.below(5)],
                    ids[chance.below(5)], chance.below(2) == 0 ? chance.below(4) : (1ULL << 48) - 1 - chance.below(4)});
  for (const Key& a : keys)
    for (const Key& b : keys) ASSERT_EQ(event_of(a) < event_of(b), a.tuple() < b.tuple());
}

TEST(EventOrder, KindDoesNotDecideBeforeTheSerial) {
  EXPECT_LT(event_of({0, Phase::timer, 1, 1, 1}, 0xFFFF), event_of({0, Phase::timer, 1, 1, 2}, 0));
}

TEST(Event, PacksAndUnpacksTheExtremes) {
  for (const std::uint32_t node : {0u, 1u, 0xAAAAAAAu, max_components - 1}) {
    for (const std::uint32_t source : {0u, 1u, 0x15555555u, max_components - 1}) {
      for (const Phase phase : {Phase::control, Phase::arrival, Phase::timer, Phase::decision, Phase::judgement}) {
        const Event event = event_of({5, phase, node, source, (1ULL << 48) - 1}, 0xABCD);
        EXPECT_EQ(event.node().index, node);
        EXPECT_EQ(event.source().index, source);
        EXPECT_EQ(event.target().index, node);
        EXPECT_EQ(event.kind(), 0xABCD);
        EXPECT_EQ(Event::phase_of(event.order), phase);
        const Event own{TrueTime(), Event::own_order_of(phase, {node}, {source}), 0, 0};
        EXPECT_EQ(own.target().index, source);
        EXPECT_EQ(own.node().index, node);
        EXPECT_EQ(Event::phase_of(own.order), phase);
      }
    }
  }
}

TEST(EventSource, CountsItsOwnEvents) {
  EventSource one(ComponentId{4});
  EventSource other(ComponentId{5});
  EXPECT_EQ(one.next_serial_word(), 0u << 16);
  EXPECT_EQ(one.next_serial_word(), 1u << 16);
  EXPECT_EQ(other.next_serial_word(), 0u << 16);
  EXPECT_EQ(one.next_serial_word(), 2u << 16);
  EXPECT_EQ(one.id().index, 4u);
}

}  // namespace
}  // namespace takt::sim
