// SPDX-License-Identifier: Apache-2.0
// The stack in memory.
#include "pubsub/memory_stack.hpp"

#include <gtest/gtest.h>

#include <optional>

namespace takt::pubsub {
namespace {

TEST(MemoryStack, EverybodyElseHearsInOrder) {
  MemoryMedium medium;
  MemoryPort a(medium, 2, 4), b(medium, 2, 4);
  std::optional<MemoryPort> c(std::in_place, medium, 2, 4);
  const std::array<std::byte, 5> octets{std::byte{1}, std::byte{2}, std::byte{3}, std::byte{4}, std::byte{5}};
  const uadp::Octets all(octets);
  for (int round = 0; round < 5; ++round) {
    a.publish(all.first(1), {});
    a.publish(all.first(3), {});
    EXPECT_TRUE(a.next().empty()) << "nobody hears himself";
    const uadp::Octets first = b.next();
    ASSERT_EQ(first.size(), 1u);
    a.publish(all.first(4), {});
    EXPECT_EQ(first[0], std::byte{1}) << "lasts until the next call";
    EXPECT_EQ(b.next().size(), 3u);
    EXPECT_EQ(b.next().size(), 4u);
    EXPECT_TRUE(b.next().empty());
  }
  EXPECT_EQ(b.dropped(), 0u);
  EXPECT_EQ(c->dropped(), 13u) << "15 came, 2 have room";
  a.publish(all, {});
  EXPECT_EQ(b.dropped(), 1u) << "too long";
  c.reset();
  a.publish(all.first(1), {});
  EXPECT_EQ(b.next().size(), 1u);
}

}  // namespace
}  // namespace takt::pubsub
