// SPDX-License-Identifier: Apache-2.0
#include "dds/persistence/kept_records.hpp"

#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <rapidcheck/gtest.h>

#include <set>

namespace takt::dds {
namespace {

const Guid one{{{1, 2, 3}}, {0x102}};
const Guid two{{{1, 2, 3}}, {0x103}};

TEST(KeptChanges, GivesBackWhatWasPut) {
  MemoryStorage storage;
  KeptChanges kept(storage, one, {1'700'000'000});
  KeptChanges other(storage, two, {});
  CacheChange change;
  change.kind = ChangeKind::disposed;
  change.key = {1, 2, 3};
  change.source = sim::LocalTime::from_ps(1'234'567'000);
  change.payload = {std::byte{1}, std::byte{2}};
  change.original = {two, {77}};
  for (const std::int64_t number : {9, 10, 300}) {
    change.number = {number};
    kept.put(change);
  }
  other.put(change);
  kept.erase({10}, false);
  const std::vector<CacheChange> changes = kept.changes();
  ASSERT_EQ(changes.size(), 2u);
  EXPECT_EQ(changes[0].number, SequenceNumber{9});
  EXPECT_EQ(changes[1].number, SequenceNumber{300});
  EXPECT_EQ(changes[1].kind, ChangeKind::disposed);
  EXPECT_EQ(changes[1].key, change.key);
  EXPECT_EQ(changes[1].source, change.source);
  EXPECT_EQ(changes[1].payload, change.payload);
  EXPECT_EQ(changes[1].original, change.original);
  kept.erase({300}, true);
  kept.erase({9}, false);
  EXPECT_TRUE(kept.changes().empty());
  EXPECT_EQ(kept.last(), SequenceNumber{300});
}

TEST(KeptChanges, LeavesOutWhatIsDamaged) {
  MemoryStorage storage;
  KeptChanges kept(storage, one, {});
  CacheChange change;
  change.number = {5};
  kept.put(change);
  std::string name;
  storage.for_each("", [&](std::string_view each, Octets) { name = each; });
  name.back() = '6';
  storage.put(name, {});
  EXPECT_EQ(kept.changes().size(), 1u);
  EXPECT_EQ(kept.last(), SequenceNumber{5});
}

TEST(KeptNumbers, GivesBackWhatWasPut) {
  MemoryStorage storage;
  KeptNumbers kept(storage, one);
  NumberRanges numbers;
  numbers.insert({1}, {5});
  numbers.insert({8});
  kept.put(two, numbers);
  const auto all = kept.all();
  ASSERT_EQ(all.size(), 1u);
  EXPECT_EQ(all.at(two).ranges(), numbers.ranges());
  EXPECT_TRUE(KeptNumbers(storage, two).all().empty());
}

RC_GTEST_PROP(NumberRanges, AreASet, (const std::vector<std::uint8_t>& inserted)) {
  NumberRanges ranges;
  std::set<int> model;
  for (const std::uint8_t number : inserted) {
    ranges.insert({number});
    model.insert(number);
  }
  for (int i = -1; i < 257; ++i) RC_ASSERT(ranges.contains({i}) == model.contains(i));
  std::int64_t last = -2;
  for (const auto& [first, end] : ranges.ranges()) {
    RC_ASSERT(first.value > last + 1);  // neither overlapping nor touching
    last = end.value;
  }
}

TEST(NumberRanges, AreBounded) {
  NumberRanges ranges;
  for (std::int64_t i = 0; i < 1000; ++i) ranges.insert({3 * i});
  EXPECT_EQ(ranges.ranges().size(), NumberRanges::most);
  EXPECT_TRUE(ranges.contains({1}));  // the price: the lowest count as one
  EXPECT_FALSE(ranges.contains({3 * 999 - 1}));
}

}  // namespace
}  // namespace takt::dds
