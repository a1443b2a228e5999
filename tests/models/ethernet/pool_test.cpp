// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <map>
#include <set>
#include <vector>

#include "models/ethernet/traffic.hpp"
#include "sim/random.hpp"

namespace takt::models {
namespace {

using Numbers = BasicPool<std::uint64_t, FrameIndex, ChunkedSlots<std::uint64_t>>;
using LoneNumbers = BasicPool<std::uint64_t, FrameIndex, LoneSlots<std::uint64_t>>;
using ChunkedFrames = BasicPool<Frame, FrameIndex, ChunkedSlots<Frame>>;
using ChunkedPayloads = BasicPool<Payload, PayloadIndex, ChunkedSlots<Payload>>;

TEST(Pool, HandlesAreDenseAndDistinct) {
  Numbers pool;
  EXPECT_EQ(pool.live(), 0u);
  std::set<std::uint32_t> handles;
  for (int i = 0; i < 1'000; ++i) handles.insert(pool.allocate().value);
  EXPECT_EQ(handles.size(), 1'000u);
  EXPECT_LT(*handles.rbegin(), 1'024u);  // four chunks of 256
  EXPECT_EQ(pool.live(), 1'000u);
}

TEST(Pool, TheLastFreedIsUsedFirst) {
  Numbers pool;
  const FrameIndex a = pool.allocate();
  const FrameIndex b = pool.allocate();
  const FrameIndex c = pool.allocate();
  pool.free(a);
  pool.free(c);
  EXPECT_EQ(pool.live(), 1u);
  EXPECT_EQ(pool.allocate(), c);
  EXPECT_EQ(pool.allocate(), a);
  EXPECT_NE(pool.allocate(), b);
  EXPECT_EQ(pool.live(), 4u);
}

TEST(Pool, NothingIsFreedTwice) {
  Numbers numbers;
  numbers.free(numbers.allocate());
  EXPECT_THROW(numbers.free(FrameIndex{0}), sim::InvariantBroken);
  LoneNumbers lone;
  lone.free(lone.allocate());
  EXPECT_THROW(lone.free(FrameIndex{0}), sim::InvariantBroken);
}

TEST(Pool, AddressesAreStableWhileItGrows) {
  Numbers pool;
  const FrameIndex first = pool.allocate();
  std::uint64_t* const address = &pool[first];
  *address = 4711;
  for (int i = 0; i < 10'000; ++i) pool[pool.allocate()] = static_cast<std::uint64_t>(i);
  EXPECT_EQ(&pool[first], address);
  EXPECT_EQ(pool[first], 4711u);
}

/// What both pools promise: each handle is handed out once until it is freed, and its content stays.
template <class AnyPool, class Access>
void keeps_what_was_put_in(Access&& value_of) {
  AnyPool pool;
  sim::RandomStream chance(1, "pool", "test");
  std::map<std::uint32_t, std::uint64_t> oracle;
  for (int i = 0; i < 50'000; ++i) {
    if (oracle.empty() || chance.below(100) < 51) {
      const FrameIndex handle = pool.allocate();
      ASSERT_EQ(oracle.count(handle.value), 0u) << "handed out twice";
      oracle[handle.value] = value_of(pool[handle]) = chance.next();
    } else {
      auto victim =
          oracle.lower_bound(static_cast<std::uint32_t>(chance.below(oracle.rbegin()->first + std::uint64_t{1})));
      ASSERT_EQ(value_of(pool[FrameIndex{victim->first}]), victim->second);
      pool.free(FrameIndex{victim->first});
      oracle.erase(victim);
    }
    ASSERT_EQ(pool.live(), oracle.size());
  }
  for (const auto& [handle, value] : oracle) EXPECT_EQ(value_of(pool[FrameIndex{handle}]), value);
}

TEST(Pool, KeepsWhatWasPutIn) {
  keeps_what_was_put_in<Numbers>([](std::uint64_t& number) -> std::uint64_t& { return number; });
}

TEST(FramePool, KeepsWhatWasPutInWhileItGrows) {
  keeps_what_was_put_in<ChunkedFrames>([](Frame& frame) -> std::uint64_t& { return frame.sequence; });
}

TEST(LonePool, KeepsWhatWasPutIn) {
  keeps_what_was_put_in<LoneNumbers>([](std::uint64_t& number) -> std::uint64_t& { return number; });
}

// It grows at each allocation that finds nothing freed, and what was there stays where it was.
TEST(LonePool, AddressesAreStableWhileItGrows) {
  LoneNumbers pool;
  const FrameIndex first = pool.allocate();
  std::uint64_t* const address = &pool[first];
  for (std::uint32_t i = 1; i < 1'000; ++i) EXPECT_EQ(pool.allocate(), FrameIndex{i});
  EXPECT_EQ(&pool[first], address);
}

TEST(LonePool, AHandleOfWhatIsGoneIsTold) {
  LoneNumbers pool;
  const FrameIndex handle = pool.allocate();
  pool.free(handle);
  EXPECT_THROW(pool[handle], sim::InvariantBroken);
  EXPECT_THROW(pool[FrameIndex{1}], sim::InvariantBroken);
  EXPECT_THROW(pool[FrameIndex{}], sim::InvariantBroken);
}

// Frames of a whole network: whoever holds a reference while others are produced still looks at the same frame.
TEST(Traffic, FramesStayWhereTheyAre) {
  Traffic traffic;
  const StreamIndex stream = traffic.add_stream(Stream{});
  const Frame& first = traffic.frame(traffic.produce(stream, Octets{8}, sim::TrueTime()));
  for (int i = 0; i < 10'000; ++i) traffic.produce(stream, Octets{8}, sim::TrueTime());
  EXPECT_EQ(&traffic.frame(FrameIndex{0}), &first);
  EXPECT_EQ(first.sequence, 0u);
}

TEST(Traffic, NoCopyOfAFrameEndsTwice) {
  Traffic traffic;
  const StreamIndex stream = traffic.add_stream(Stream{});
  const FrameIndex frame = traffic.produce(stream, Octets{8}, sim::TrueTime());
  traffic.copy(frame);
  traffic.release(frame);
  traffic.release(frame);
  EXPECT_EQ(traffic.live_frames(), 0u);
  EXPECT_THROW(traffic.copy(frame), sim::InvariantBroken);
  EXPECT_THROW(traffic.own(frame, {}), sim::InvariantBroken);
  EXPECT_THROW(traffic.release(frame), sim::InvariantBroken);
}

TEST(FramePool, TheLastFreedIsUsedFirst) {
  ChunkedFrames pool;
  const FrameIndex a = pool.allocate();
  const FrameIndex b = pool.allocate();
  pool.free(a);
  pool.free(b);
  EXPECT_EQ(pool.live(), 0u);
  EXPECT_EQ(pool.allocate(), b);
  EXPECT_EQ(pool.allocate(), a);
  EXPECT_EQ(pool.live(), 2u);
}

TEST(Pool, PayloadsComeInSmallerChunks) {
  ChunkedPayloads pool;
  std::set<std::uint32_t> handles;
  for (int i = 0; i < 33; ++i) handles.insert(pool.allocate().value);
  EXPECT_LT(*handles.rbegin(), 64u);  // two chunks of 32
}

}  // namespace
}  // namespace takt::models
