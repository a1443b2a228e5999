// SPDX-License-Identifier: Apache-2.0
// Ownership, deadline, lifespan, time-based filter and destination order against sequences made by hand.
#include <gtest/gtest.h>

#include "arrivals.hpp"

namespace takt::dds::reader_policies_test {
namespace {

using namespace sim::literals;
using Values = std::vector<int>;

ReaderHistory::Settings keep_all() {
  ReaderHistory::Settings settings;
  settings.history.keep_all = true;
  return settings;
}
ReaderHistory::Settings exclusive(sim::Duration deadline = infinite) {
  ReaderHistory::Settings settings = keep_all();
  settings.exclusive = true;
  settings.deadline = deadline;
  return settings;
}

TEST(Ownership, TheStrongestWriterOwnsEachInstance) {
  Feed feed(exclusive());
  EXPECT_EQ(feed.add(1, a, 1, start, 5), Admission::accepted);
  EXPECT_EQ(feed.add(2, a, 2, start, 4), Admission::not_owner);
  EXPECT_EQ(feed.add(2, b, 3, start, 4), Admission::accepted);
  EXPECT_EQ(feed.add(3, a, 4, start, 6), Admission::accepted);
  EXPECT_EQ(feed.add(1, a, 5, start, 5), Admission::not_owner);
  EXPECT_EQ(feed.drain_all(), (Values{1, 3, 4}));
  EXPECT_EQ(feed.history.owner_of(a), writer(3));
}

TEST(Ownership, OfEquallyStrongOnesTheLowerGuidOwns) {
  Feed feed(exclusive());
  EXPECT_EQ(feed.add(2, a, 1, start, 5), Admission::accepted);
  EXPECT_EQ(feed.add(3, a, 2, start, 5), Admission::not_owner);
  EXPECT_EQ(feed.add(1, a, 3, start, 5), Admission::accepted);
  EXPECT_EQ(feed.add(2, a, 4, start, 5), Admission::not_owner);
}

TEST(Ownership, IsLostByADeadlineMissed) {
  Feed feed(exclusive(10_ms));
  feed.add(1, a, 1, start, 5);
  EXPECT_EQ(feed.add(2, a, 2, start + 9_ms, 1), Admission::not_owner);
  feed.history.advance(start + 10_ms);
  EXPECT_EQ(feed.history.owner_of(a), std::nullopt);
  EXPECT_EQ(feed.add(2, a, 3, start + 11_ms, 1), Admission::accepted);
  EXPECT_EQ(feed.add(1, a, 4, start + 12_ms, 5), Admission::accepted);  // and won back
}

TEST(Ownership, IsLostByUnregistration) {
  Feed feed(exclusive());
  feed.add(1, a, 1, start, 5);
  feed.add(2, a, 2, start, 1);
  feed.add(1, a, 0, start, 5, ChangeKind::unregistered);
  EXPECT_EQ(feed.add(2, a, 3, start, 1), Admission::accepted);
  EXPECT_EQ(feed.drain_all(), (Values{1, 3}));  // 2 is still a writer of it, so nothing ends
}

TEST(Ownership, IsLostWithTheWriter) {
  Feed feed(exclusive());
  feed.add(1, a, 1, start, 5);
  feed.add(2, a, 2, start, 1);
  feed.history.writer_gone(writer(1), start);
  EXPECT_EQ(feed.add(2, a, 3, start, 1), Admission::accepted);
}

TEST(Ownership, OnlyTheOwnerDisposes) {
  Feed feed(exclusive());
  feed.add(1, a, 1, start, 5);
  feed.add(2, a, 2, start, 1);
  EXPECT_EQ(feed.add(2, a, 0, start, 1, ChangeKind::disposed), Admission::not_owner);
  EXPECT_EQ(feed.drain_all(), (Values{1}));
  EXPECT_EQ(feed.add(1, a, 0, start, 5, ChangeKind::disposed), Admission::accepted);
  EXPECT_EQ(feed.drain_all(), (Values{-1}));
}

TEST(Ownership, SharedTakesAll) {
  Feed feed(keep_all());
  feed.add(1, a, 1, start, 5);
  feed.add(2, a, 2, start, 4);
  EXPECT_EQ(feed.drain_all(), (Values{1, 2}));
}

TEST(Deadline, IsCountedPerInstanceAndPeriod) {
  ReaderHistory::Settings settings = keep_all();
  settings.deadline = 10_ms;
  Feed feed(settings);
  feed.add(1, a, 1, start);
  feed.add(1, b, 2, start + 4_ms);
  EXPECT_EQ(feed.history.next_deadline(), start + 10_ms);
  feed.history.advance(start + 10_ms);
  EXPECT_EQ(feed.history.deadline_missed().total_count, 1u);
  EXPECT_EQ(feed.history.deadline_missed().last_instance, a);
  feed.add(1, b, 3, start + 12_ms);
  feed.history.advance(start + 21_ms);  // a at 20; b is due at 22
  EXPECT_EQ(feed.history.deadline_missed().total_count, 2u);
  feed.add(1, a, 0, start + 21_ms, 0, ChangeKind::disposed);
  feed.history.advance(start + 100_ms);  // b at 22, 32, ... 92; nobody waits for what was disposed
  EXPECT_EQ(feed.history.deadline_missed().total_count, 10u);
}

TEST(Lifespan, ASampleExpiresAtTheReader) {
  Feed feed(keep_all());
  EXPECT_EQ(feed.add_stamped(1, a, 1, start, start + 1_ms, 0, ChangeKind::alive, start + 10_ms), Admission::accepted);
  EXPECT_EQ(feed.add_stamped(1, a, 2, start, start + 1_ms, 0, ChangeKind::alive, start + 20_ms), Admission::accepted);
  EXPECT_EQ(feed.add_stamped(1, a, 3, start, start + 10_ms, 0, ChangeKind::alive, start + 10_ms), Admission::expired);
  EXPECT_EQ(feed.history.read(start + 10_ms - 1_ps).size(), 1u);  // what comes at 10 ms has let 1 go already
  EXPECT_EQ(feed.drain_all(start + 10_ms), (Values{2}));
}

TEST(TimeBasedFilter, KeepsTheMinimumSeparationOfAnInstance) {
  ReaderHistory::Settings settings = keep_all();
  settings.minimum_separation = 10_ms;
  Feed feed(settings);
  EXPECT_EQ(feed.add(1, a, 1, start), Admission::accepted);
  EXPECT_EQ(feed.add(1, a, 2, start + 10_ms - 1_ps), Admission::filtered);
  EXPECT_EQ(feed.add(1, b, 3, start + 5_ms), Admission::accepted);
  EXPECT_EQ(feed.add(1, a, 4, start + 10_ms), Admission::accepted);
  EXPECT_EQ(feed.add(1, a, 5, start + 19_ms), Admission::filtered);
  EXPECT_EQ(feed.add(1, a, 6, start + 20_ms), Admission::accepted);
  EXPECT_EQ(feed.drain_all(), (Values{1, 3, 4, 6}));
}

TEST(DestinationOrder, BySourceTimestamp) {
  ReaderHistory::Settings settings = keep_all();
  settings.by_source = true;
  Feed feed(settings);
  feed.add_stamped(2, a, 20, start + 2_ms, start + 5_ms);
  feed.add_stamped(1, a, 10, start + 1_ms, start + 6_ms);
  feed.add_stamped(1, a, 30, start + 3_ms, start + 7_ms);
  feed.add_stamped(1, a, 21, start + 2_ms, start + 8_ms);  // equally old: by the writer's GUID
  EXPECT_EQ(feed.drain_all(), (Values{10, 21, 20, 30}));
  EXPECT_EQ(feed.add_stamped(2, a, 25, start + 2_ms, start + 9_ms), Admission::outdated);  // older than what was taken
}

TEST(DestinationOrder, BySourceKeepLastKeepsTheLatestWritten) {
  ReaderHistory::Settings settings;
  settings.by_source = true;
  Feed feed(settings);
  feed.add_stamped(1, a, 2, start + 2_ms, start + 5_ms);
  EXPECT_EQ(feed.add_stamped(2, a, 1, start + 1_ms, start + 6_ms), Admission::outdated);
  EXPECT_EQ(feed.drain_all(), (Values{2}));
}

TEST(DestinationOrder, ByReceptionKeepLastKeepsTheLatestReceived) {
  Feed feed({});
  feed.add_stamped(1, a, 2, start + 2_ms, start + 5_ms);
  feed.add_stamped(2, a, 1, start + 1_ms, start + 6_ms);
  EXPECT_EQ(feed.drain_all(), (Values{1}));
}

}  // namespace
}  // namespace takt::dds::reader_policies_test
