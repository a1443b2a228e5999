// SPDX-License-Identifier: Apache-2.0
#include "sim/insertion_sort.hpp"

#include <gtest/gtest.h>

#include <utility>
#include <vector>

namespace takt::sim {
namespace {

using Items = std::vector<std::pair<int, char>>;

TEST(InsertionSort, KeepsTheOrderOfWhatIsEqual) {
  Items items = {{2, 'a'}, {1, 'b'}, {2, 'c'}, {0, 'd'}, {1, 'e'}, {2, 'f'}};
  insertion_sort(items, [](const auto& a, const auto& b) { return a.first < b.first; });
  EXPECT_EQ(items, (Items{{0, 'd'}, {1, 'b'}, {1, 'e'}, {2, 'a'}, {2, 'c'}, {2, 'f'}}));
}

TEST(InsertionSort, NothingAndOneThingAreInOrder) {
  Items none, one = {{1, 'a'}};
  const auto less = [](const auto& a, const auto& b) { return a.first < b.first; };
  insertion_sort(none, less);
  insertion_sort(one, less);
  EXPECT_TRUE(none.empty());
  EXPECT_EQ(one, (Items{{1, 'a'}}));
}

}  // namespace
}  // namespace takt::sim
