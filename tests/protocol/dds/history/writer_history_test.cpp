// SPDX-License-Identifier: Apache-2.0
#include "dds/history/writer_history.hpp"

#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <rapidcheck/gtest.h>

#include "dds/history/expiry.hpp"
#include "sim/check.hpp"

namespace takt::dds::writer_history_test {
namespace {

using namespace sim::literals;

constexpr sim::LocalTime start = sim::LocalTime::from_ps(0);
constexpr InstanceKey a{1};
constexpr InstanceKey b{2};

WriterHistory history_of(const HistorySettings& limits, bool keeps_released = false,
                         sim::Duration lifespan = infinite) {
  WriterHistory::Settings settings;
  settings.history = limits;
  settings.keeps_released = keeps_released;
  settings.lifespan = lifespan;
  return WriterHistory(settings);
}
std::int64_t add(WriterHistory& history, const InstanceKey& key, ChangeKind kind = ChangeKind::alive,
                 sim::LocalTime now = start) {
  return history.add(kind, key, {}, now).number.value;
}
std::vector<std::int64_t> numbers(const WriterHistory& history) {
  std::vector<std::int64_t> all;
  for (const auto& [number, change] : history.changes()) all.push_back(number.value);
  return all;
}

TEST(WriterHistory, KeepLastReplacesTheOldestOfTheInstance) {
  WriterHistory history = history_of({.depth = 2});
  for (const InstanceKey& key : {a, b, a, a, a, b}) {
    ASSERT_FALSE(history.obstacle(key, start));
    add(history, key);
  }
  EXPECT_EQ(numbers(history), (std::vector<std::int64_t>{2, 4, 5, 6}));  // of a 4 and 5, of b 2 and 6
  EXPECT_EQ(history.first(), SequenceNumber{2});
  EXPECT_EQ(history.last(), SequenceNumber{6});
}

TEST(WriterHistory, KeepAllWaitsForWhatIsReleased) {
  WriterHistory history =
      history_of({.keep_all = true, .max_samples = 3, .max_instances = 2, .max_samples_per_instance = 2});
  add(history, a);
  add(history, a);
  EXPECT_EQ(history.obstacle(a, start), NoRoom::max_samples_per_instance);
  add(history, b);
  EXPECT_EQ(history.obstacle(b, start), NoRoom::max_samples);
  EXPECT_EQ(history.obstacle(InstanceKey{3}, start), NoRoom::max_instances);
  history.release(SequenceNumber{2});
  EXPECT_EQ(history.obstacle(a, start), std::nullopt);
  EXPECT_EQ(numbers(history), (std::vector<std::int64_t>{2, 3}));
}

TEST(WriterHistory, ATransientLocalHistoryGivesUpReleasedChangesOnlyForNewOnes) {
  WriterHistory history = history_of({.keep_all = true, .max_samples = 2}, true);
  add(history, a);
  add(history, b);
  history.release(SequenceNumber{3});
  EXPECT_EQ(numbers(history), (std::vector<std::int64_t>{1, 2}));
  EXPECT_EQ(history.obstacle(a, start), std::nullopt);
  add(history, a);
  EXPECT_EQ(numbers(history), (std::vector<std::int64_t>{2, 3}));
}

TEST(WriterHistory, AnUnregisteredInstanceIsForgottenWhenItsEndIsReleased) {
  for (const bool keeps : {false, true}) {
    WriterHistory history = history_of({.depth = 4, .max_instances = 1}, keeps);
    add(history, a);
    add(history, a, ChangeKind::disposed_unregistered);
    history.release(SequenceNumber{2});
    EXPECT_EQ(history.obstacle(b, start), NoRoom::max_instances) << keeps;
    history.release(SequenceNumber{3});
    EXPECT_EQ(history.instances(), 0u) << keeps;
    EXPECT_EQ(history.obstacle(b, start), std::nullopt) << keeps;
  }
}

TEST(WriterHistory, AnInstanceThatIsWrittenAgainIsNotForgotten) {
  WriterHistory history = history_of({.depth = 4}, true);
  add(history, a, ChangeKind::disposed_unregistered);
  add(history, a);
  history.release(SequenceNumber{3});
  EXPECT_EQ(numbers(history), (std::vector<std::int64_t>{1, 2}));
}

// A timestamp of another scale saturates far before local time 0. With an infinite lifespan it made the change expire
// at 0, by an overflow.
TEST(WriterHistory, AnInfiniteLifespanNeverEndsWhateverTheTimestamp) {
  const sim::LocalTime before_all = sim::LocalTime::from_ps(-sim::Duration::max().ps());
  EXPECT_EQ(expiry_of(before_all, infinite), sim::LocalTime::never());
  EXPECT_EQ(expiry_of(sim::LocalTime(), infinite), sim::LocalTime::never());
  EXPECT_EQ(expiry_of(before_all, 1_s), before_all + 1_s);
  EXPECT_EQ(expiry_of(sim::LocalTime::from_ps(1), sim::Duration::max() - sim::Duration::from_ps(1)),
            sim::LocalTime::never());
  EXPECT_EQ(expiry_of(sim::LocalTime() + 2_s, 1_s), sim::LocalTime() + 3_s);
}

TEST(WriterHistory, LifespanCountsFromTheWrite) {
  WriterHistory history = history_of({.keep_all = true, .max_samples = 2}, true, 10_ms);
  add(history, a, ChangeKind::alive, start);
  add(history, a, ChangeKind::alive, start + 4_ms);
  EXPECT_EQ(history.next_expiry(), start + 10_ms);
  EXPECT_EQ(history.obstacle(a, start + 10_ms - 1_ps), NoRoom::max_samples);
  EXPECT_EQ(history.obstacle(a, start + 10_ms), std::nullopt);
  EXPECT_EQ(numbers(history), (std::vector<std::int64_t>{2}));
  EXPECT_EQ(history.next_expiry(), start + 14_ms);
}

TEST(WriterHistory, GoesOnBehindWhatWasKeptElsewhere) {
  WriterHistory::Settings settings;
  settings.keeps_released = true;
  WriterHistory history(settings);
  history.go_on_after(SequenceNumber{6});
  CacheChange kept;
  kept.number = SequenceNumber{9};
  kept.key = a;
  history.restore(kept);
  EXPECT_EQ(add(history, b), 10);
  EXPECT_EQ(numbers(history), (std::vector<std::int64_t>{9, 10}));
  EXPECT_THROW(history.restore(kept), sim::InvariantBroken);
}

TEST(DeadlineTable, EachPeriodThatPassesIsMissedOnce) {
  DeadlineTable table(10_ms);
  table.updated(b, start);
  table.updated(a, start);
  table.updated(a, start + 5_ms);
  std::vector<std::pair<std::int64_t, int>> missed;
  const auto advance_to = [&](sim::LocalTime now) {
    table.advance(now, [&](const InstanceKey& key) { missed.emplace_back(now.ps() / 1'000'000'000, key[0]); });
  };
  advance_to(start + 10_ms - 1_ps);
  EXPECT_TRUE(missed.empty());
  EXPECT_EQ(table.next(), start + 10_ms);
  advance_to(start + 10_ms);
  advance_to(start + 31_ms);  // a at 15 and 25, b at 20 and 30
  EXPECT_EQ(missed, (std::vector<std::pair<std::int64_t, int>>{{10, 2}, {31, 1}, {31, 2}, {31, 1}, {31, 2}}));
  table.forget(b);
  EXPECT_EQ(table.next(), start + 35_ms);
}

// Against a model: a list of what was added, cut down by the rules' words.
RC_GTEST_PROP(WriterHistory, KeepsTheNewestOfEachInstance, ()) {
  const auto depth = *rc::gen::inRange<std::uint32_t>(1, 5);
  const auto keys = *rc::gen::container<std::vector<std::uint8_t>>(rc::gen::inRange<std::uint8_t>(0, 4));
  WriterHistory history = history_of({.depth = depth}, true);
  std::map<std::uint8_t, std::vector<std::int64_t>> model;
  for (const std::uint8_t key : keys) {
    RC_ASSERT(!history.obstacle(InstanceKey{key}, start));
    const std::int64_t number = add(history, InstanceKey{key});
    if (*rc::gen::arbitrary<bool>()) history.release(SequenceNumber{number});
    model[key].push_back(number);
  }
  std::set<std::int64_t> expected;
  for (const auto& [key, all] : model) expected.insert(all.size() > depth ? all.end() - depth : all.begin(), all.end());
  RC_ASSERT(numbers(history) == std::vector<std::int64_t>(expected.begin(), expected.end()));
}

}  // namespace
}  // namespace takt::dds::writer_history_test
