// SPDX-License-Identifier: Apache-2.0
#include "dds/history/reader_history.hpp"

#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <rapidcheck/gtest.h>

#include "arrivals.hpp"

namespace takt::dds::reader_history_test {
namespace {

using namespace sim::literals;
using Values = std::vector<int>;

ReaderHistory::Settings with(const HistorySettings& limits) {
  ReaderHistory::Settings settings;
  settings.history = limits;
  return settings;
}

TEST(ReaderHistory, KeepLastReplacesTheOldestOfTheInstance) {
  Feed feed(with({.depth = 2}));
  for (const auto& [key, value] : {std::pair(a, 1), {b, 2}, {a, 3}, {a, 4}, {b, 5}})
    EXPECT_EQ(feed.add(1, key, value, start), Admission::accepted);
  EXPECT_EQ(feed.drain_all(), (Values{2, 3, 4, 5}));
}

TEST(ReaderHistory, KeepAllRejectsAndSaysWhy) {
  Feed feed(with({.keep_all = true, .max_samples = 3, .max_instances = 2, .max_samples_per_instance = 2}));
  const auto reject = [&](const InstanceKey& key, RejectedBy reason) {
    const std::uint64_t before = feed.history.sample_rejected().total_count;
    EXPECT_FALSE(feed.history.has_room(key, start));
    EXPECT_EQ(feed.add(1, key, 9, start), Admission::rejected);
    EXPECT_EQ(feed.history.sample_rejected().total_count, before + 1);
    EXPECT_EQ(feed.history.sample_rejected().last_reason, reason);
    EXPECT_EQ(feed.history.sample_rejected().last_instance, key);
  };
  feed.add(1, a, 1, start);
  feed.add(1, a, 2, start);
  reject(a, RejectedBy::samples_per_instance_limit);
  feed.add(1, b, 3, start);
  reject(b, RejectedBy::samples_limit);
  reject(InstanceKey{3}, RejectedBy::instances_limit);
  EXPECT_EQ(feed.history.take(start)->payload.at(0), std::byte{1});
  EXPECT_TRUE(feed.history.has_room(a, start));
  EXPECT_EQ(feed.add(1, a, 4, start), Admission::accepted);
  EXPECT_EQ(feed.drain_all(), (Values{2, 3, 4}));
}

TEST(ReaderHistory, TellsViewAndInstanceStates) {
  Feed feed(with({.depth = 8}));
  feed.add(1, a, 1, start);
  feed.add(1, a, 2, start + 1_ms);
  const Sample first = *feed.history.take(start);
  EXPECT_TRUE(first.info.is_new_instance);
  EXPECT_EQ(first.info.writer, writer(1));
  EXPECT_EQ(first.info.number, SequenceNumber{1});
  EXPECT_FALSE(feed.history.take(start)->info.is_new_instance);

  feed.add(1, a, 0, start, 0, ChangeKind::disposed);
  const Sample disposed = *feed.history.take(start);
  EXPECT_FALSE(disposed.info.valid_data);
  EXPECT_EQ(disposed.info.instance_state, InstanceState::not_alive_disposed);
}

TEST(ReaderHistory, CountsGenerations) {
  Feed feed(with({.depth = 8}));
  feed.add(1, a, 1, start);
  feed.add(1, a, 0, start, 0, ChangeKind::disposed);
  feed.add(1, a, 2, start);
  feed.add(1, a, 0, start, 0, ChangeKind::unregistered);
  feed.add(1, a, 3, start);
  const std::vector<Sample> all = feed.history.read(start);
  std::vector<std::tuple<bool, unsigned, unsigned>> seen;
  for (const Sample& sample : all)
    seen.emplace_back(sample.info.valid_data, sample.info.disposed_generation_count,
                      sample.info.no_writers_generation_count);
  // The sample without data tells the latest end only.
  EXPECT_EQ(seen, (std::vector<std::tuple<bool, unsigned, unsigned>>{
                      {true, 0, 0}, {true, 1, 0}, {false, 1, 0}, {true, 1, 1}}));
  EXPECT_FALSE(all[0].info.is_read);
  EXPECT_TRUE(feed.history.read(start)[0].info.is_read);
  EXPECT_EQ(feed.history.read(start).size(), 4u);
}

TEST(ReaderHistory, AnInstanceHasNoWritersWhenTheLastOneLeaves) {
  Feed feed(with({.depth = 8}));
  feed.add(1, a, 1, start);
  feed.add(2, a, 2, start);
  feed.add(1, a, 0, start, 0, ChangeKind::unregistered);
  EXPECT_EQ(feed.drain_all(), (Values{1, 2}));
  feed.history.writer_gone(writer(2), start);
  const Sample gone = *feed.history.take(start);
  EXPECT_FALSE(gone.info.valid_data);
  EXPECT_EQ(gone.info.instance_state, InstanceState::not_alive_no_writers);
  EXPECT_EQ(feed.history.instances(), 0u);
}

TEST(ReaderHistory, DisposeTakesNoRoomFromData) {
  Feed feed(with({.depth = 1, .max_samples = 1}));
  feed.add(1, a, 1, start);
  feed.add(1, a, 0, start, 0, ChangeKind::disposed);
  EXPECT_EQ(feed.drain_all(), (Values{1, -1}));
}

TEST(ReaderHistory, AutopurgeAfterItsDelay) {
  ReaderHistory::Settings settings = with({.depth = 1});
  settings.data_lifecycle.autopurge_disposed_samples_delay = 5_ms;
  Feed feed(settings);
  feed.add(1, a, 1, start);
  feed.add(1, a, 0, start, 0, ChangeKind::disposed);
  feed.add(1, b, 2, start);
  EXPECT_EQ(feed.history.read(start + 5_ms - 1_ps).size(), 3u);
  EXPECT_EQ(feed.drain_all(start + 5_ms), (Values{2}));
}

// Against a model, with takes between.
RC_GTEST_PROP(ReaderHistory, KeepsTheNewestThatWereNotTaken, ()) {
  const auto depth = *rc::gen::inRange<std::uint32_t>(1, 4);
  const auto steps = *rc::gen::container<std::vector<std::uint8_t>>(rc::gen::inRange<std::uint8_t>(0, 5));
  Feed feed(with({.depth = depth}));
  std::vector<std::pair<std::uint8_t, int>> model;
  int value = 0;
  for (const std::uint8_t step : steps) {
    if (step == 4) {
      const std::optional<Sample> sample = feed.history.take(start);
      RC_ASSERT(sample.has_value() == !model.empty());
      if (!sample) continue;
      RC_ASSERT(std::to_integer<int>(sample->payload.at(0)) == model.front().second);
      model.erase(model.begin());
      continue;
    }
    value = (value + 1) % 256;
    feed.add(1, InstanceKey{step}, value, start);
    model.emplace_back(step, value);
    const auto of_step = [&](const auto& each) { return each.first == step; };
    if (std::count_if(model.begin(), model.end(), of_step) > depth)
      model.erase(std::find_if(model.begin(), model.end(), of_step));
  }
  RC_ASSERT(feed.history.size() == model.size());
}

}  // namespace
}  // namespace takt::dds::reader_history_test
