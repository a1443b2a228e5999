#include "models/ethernet/frame_pool.hpp"

#include <gtest/gtest.h>

#include <map>
#include <set>
#include <vector>

#include "sim/random.hpp"

namespace takt::models {
namespace {

using Numbers = Pool<std::uint64_t, FrameIndex>;

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
  FramePool frames;
  frames.free(frames.allocate());
  EXPECT_THROW(frames.free(FrameIndex{0}), sim::InvariantBroken);
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
      auto victim = oracle.lower_bound(static_cast<std::uint32_t>(chance.below(oracle.rbegin()->first + std::uint64_t{1})));
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

TEST(FramePool, KeepsWhatWasPutInWhileItMoves) {
  keeps_what_was_put_in<FramePool>([](Frame& frame) -> std::uint64_t& { return frame.sequence; });
}

TEST(FramePool, TheLastFreedIsUsedFirst) {
  FramePool pool;
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
  PayloadPool pool;
  std::set<std::uint32_t> handles;
  for (int i = 0; i < 33; ++i) handles.insert(pool.allocate().value);
  EXPECT_LT(*handles.rbegin(), 64u);  // two chunks of 32
}

}  // namespace
}  // namespace takt::models
