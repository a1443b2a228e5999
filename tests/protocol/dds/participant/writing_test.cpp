// SPDX-License-Identifier: Apache-2.0
// Blocking writes, KEEP_LAST over the wire, late joiners, lifespan.
#include "pair.hpp"

namespace takt::dds {
namespace {

using namespace sim::literals;
using Values = std::vector<std::uint32_t>;

WriterConfig keep_all(std::int32_t max_samples, sim::Duration patience = 50_ms) {
  WriterConfig config = writer_config();
  config.qos.history.kind = HistoryKind::keep_all;
  config.qos.resource_limits.max_samples = max_samples;
  config.qos.reliability.max_blocking_time = patience;
  return config;
}
WriterConfig durable(std::int32_t depth) {
  WriterConfig config = writer_config();
  config.qos.durability.kind = DurabilityKind::transient_local;
  config.qos.history.depth = depth;
  return config;
}
ReaderConfig late(DurabilityKind durability) {
  ReaderConfig config = reader_config();
  config.qos.durability.kind = durability;
  return config;
}

TEST(BlockingWrite, GoesOnWhenAnAcknackFreesRoom) {
  Pair pair(keep_all(2));
  pair.world.run_for(1_s);
  EXPECT_EQ(pair.write(1).verdict, WriteVerdict::written);
  EXPECT_EQ(pair.write(2).verdict, WriteVerdict::written);  // fills the history: its HEARTBEAT travels along
  const sim::LocalTime now = pair.world.now;
  const WriteResult blocked = pair.write(3);
  EXPECT_EQ(blocked.verdict, WriteVerdict::would_block);
  EXPECT_EQ(blocked.until, now + 50_ms);
  pair.world.events.clear();
  pair.world.run_for(1_s);
  ASSERT_EQ(pair.world.count(EventKind::writable, 0), 1u);
  for (const auto& [who, event] : pair.world.events) {
    if (event.kind == EventKind::writable) {
      EXPECT_EQ(event.at, now + 100_us + 5_ms + 100_us);  // one way, the response delay, one way
    }
  }
  EXPECT_EQ(pair.write(3).verdict, WriteVerdict::written);
  pair.world.run_for(1_s);
  EXPECT_EQ(pair.take(), (Values{1, 2, 3}));
  EXPECT_EQ(pair.world.count(EventKind::write_timed_out, 0), 0u);
}

TEST(BlockingWrite, TimesOutAtTheEndOfMaxBlockingTime) {
  Pair pair(keep_all(1));
  pair.world.run_for(1_s);
  pair.world.medium = [](const Sent&) { return std::vector<sim::Duration>(); };
  pair.write(1);
  const sim::LocalTime now = pair.world.now;
  EXPECT_EQ(pair.write(2).until, now + 50_ms);
  pair.world.events.clear();
  pair.world.run_for(1_s);
  ASSERT_EQ(pair.world.events.size(), 1u);
  EXPECT_EQ(pair.world.events[0].second.kind, EventKind::write_timed_out);
  EXPECT_EQ(pair.world.events[0].second.at, now + 50_ms);
}

TEST(BlockingWrite, WithoutPatienceIsRefused) {
  Pair pair(keep_all(1, 0_ms));
  pair.write(1);
  const WriteResult result = pair.write(2);
  EXPECT_EQ(result.verdict, WriteVerdict::refused);
  EXPECT_EQ(result.reason, "timeout: the history is full, and max_blocking_time is 0");
}

TEST(BlockingWrite, AReaderThatIsFullHoldsTheWriterUp) {
  ReaderConfig full = reader_config();
  full.qos.resource_limits.max_samples = 2;
  Pair pair(keep_all(1, infinite), full);
  pair.world.run_for(1_s);
  Values written;
  const auto write_some = [&] {
    for (int i = 0; i < 10; ++i) {
      const auto value = static_cast<std::uint32_t>(written.size() + 1);
      if (pair.write(value).verdict != WriteVerdict::written) break;
      written.push_back(value);
      pair.world.run_for(10_s);
    }
  };
  write_some();
  EXPECT_EQ(written.size(), 3u);  // two at the reader, one at the writer
  EXPECT_GE(pair.world.count(EventKind::sample_rejected, 1), 1u);
  // The reader asks for nothing that it has no room for.
  EXPECT_EQ(pair.reading->reader(pair.reader).rtps.history().sample_rejected().total_count, 1u);
  EXPECT_EQ(value_of(*pair.reading->take(pair.reader, pair.world.now)), 1u);
  pair.world.run_for(1_s);
  EXPECT_EQ(pair.take(), (Values{2, 3}));
  pair.world.run_for(10_s);
  write_some();
  pair.world.run_for(10_s);
  EXPECT_EQ(pair.take(), (Values{4, 5}));
}

TEST(KeepLast, KeepsTheNewestWhileTheReaderIsAway) {
  WriterConfig config = writer_config();
  config.qos.history.depth = 3;
  Pair pair(config);
  pair.world.run_for(1_s);
  pair.world.medium = [](const Sent&) { return std::vector<sim::Duration>(); };
  for (std::uint32_t i = 1; i <= 10; ++i) pair.write(i);
  pair.world.medium = World().medium;
  pair.world.run_for(10_s);
  EXPECT_EQ(pair.take(), (Values{8, 9, 10}));
  EXPECT_EQ(pair.reading->reader(pair.reader).rtps.sample_lost().total_count, 7u);
}

// Instances whose newest change is old: the history has holes, which the reader is told of by GAPs.
TEST(KeepLast, HolesOfTheHistoryHoldNobodyUp) {
  WriterConfig writing = writer_config();
  ReaderConfig reading = reader_config();
  writing.has_key = reading.has_key = true;
  Pair pair(writing, reading);
  pair.world.run_for(1_s);
  pair.world.medium = [](const Sent&) { return std::vector<sim::Duration>(); };
  pair.write(1, 12, InstanceKey{1});
  for (std::uint32_t i = 2; i <= 400; ++i) pair.write(i, 12, InstanceKey{2});
  pair.world.medium = World().medium;
  pair.world.run_for(20_s);
  EXPECT_EQ(pair.take(), (Values{1, 400}));
  EXPECT_TRUE(pair.writing->writer(pair.writer).rtps.is_acknowledged());
}

TEST(LateJoiner, GetsTheHistoryOfATransientLocalWriter) {
  for (const DurabilityKind durability : {DurabilityKind::volatile_, DurabilityKind::transient_local}) {
    Pair pair(durable(3));
    for (std::uint32_t i = 1; i <= 5; ++i) pair.write(i);
    pair.world.run_for(10_s);
    EXPECT_EQ(pair.take(), (Values{1, 2, 3, 4, 5}));
    const ReaderHandle second = *pair.reading->create_reader(late(durability), pair.world.now).handle;
    pair.world.match(*pair.writing, pair.writer, *pair.reading, second);
    pair.world.run_for(10_s);
    pair.write(6);
    pair.world.run_for(10_s);
    EXPECT_EQ(drain_values(*pair.reading, second, pair.world.now),
              durability == DurabilityKind::volatile_ ? (Values{6}) : (Values{3, 4, 5, 6}));
    EXPECT_EQ(pair.take(), (Values{6}));
    EXPECT_EQ(pair.reading->reader(second).rtps.sample_lost().total_count, 0u);
  }
}

TEST(LateJoiner, ThatIsBestEffortGetsNoPast) {
  Pair pair(durable(3));
  pair.write(1);
  ReaderConfig config = late(DurabilityKind::transient_local);
  config.qos.reliability.kind = ReliabilityKind::best_effort;
  const ReaderHandle second = *pair.reading->create_reader(config, pair.world.now).handle;
  pair.world.match(*pair.writing, pair.writer, *pair.reading, second);
  pair.write(2);
  pair.world.run_for(10_s);
  EXPECT_EQ(drain_values(*pair.reading, second, pair.world.now), (Values{2}));
}

TEST(LateJoiner, GetsItThoughAllOfItWasLost) {
  Pair pair(durable(5));
  for (std::uint32_t i = 1; i <= 5; ++i) pair.write(i, 4000);
  pair.world.run_for(10_s);
  int left = 25;
  pair.world.medium = [&](const Sent&) { return left-- > 0 ? std::vector<sim::Duration>() : std::vector{100_us}; };
  const ReaderHandle second =
      *pair.reading->create_reader(late(DurabilityKind::transient_local), pair.world.now).handle;
  pair.world.match(*pair.writing, pair.writer, *pair.reading, second);
  pair.world.run_for(120_s);
  EXPECT_EQ(drain_values(*pair.reading, second, pair.world.now), (Values{1, 2, 3, 4, 5}));
}

TEST(Lifespan, SamplesExpireUnderWayAndInBothHistories) {
  WriterConfig config = durable(8);
  config.qos.lifespan.duration = 100_ms;
  Pair pair(config);
  pair.write(1);
  pair.world.run_for(50_ms);
  pair.write(2);
  pair.world.run_for(60_ms);
  EXPECT_EQ(pair.take(), (Values{2}));
  const ReaderHandle second =
      *pair.reading->create_reader(late(DurabilityKind::transient_local), pair.world.now).handle;
  pair.world.run_for(50_ms);
  pair.world.match(*pair.writing, pair.writer, *pair.reading, second);
  pair.write(3);
  pair.world.run_for(10_s);
  pair.world.medium = [](const Sent&) { return std::vector{150_ms}; };
  pair.write(4);
  pair.world.run_for(10_s);
  EXPECT_EQ(drain_values(*pair.reading, second, pair.world.now), Values());
}

TEST(BestEffort, IsSentOnceInOrderAndCountsWhatIsMissing) {
  Pair pair(writer_config(ReliabilityKind::best_effort), reader_config(ReliabilityKind::best_effort));
  std::vector<sim::Duration> delays{1_ms, 1_ms, 5_ms, 1_ms, 1_ms, 1_ms};
  std::size_t next = 0;
  pair.world.medium = [&](const Sent&) {
    return ++next == 5 ? std::vector<sim::Duration>() : std::vector{delays[next - 1]};
  };
  for (std::uint32_t i = 1; i <= 6; ++i) {
    pair.write(i);
    pair.world.run_for(2_ms);
  }
  pair.world.run_for(10_s);
  EXPECT_EQ(pair.take(), (Values{1, 2, 4, 6}));  // 3 came after 4, 5 was lost
  EXPECT_EQ(pair.reading->reader(pair.reader).rtps.sample_lost().total_count, 2u);
  for (const std::string& kinds : pair.sent()) EXPECT_EQ(kinds, "INFO_TS DATA");
  EXPECT_TRUE(pair.sent_by(1).empty());
}

TEST(BestEffort, AnyLargeSampleOfWhichAFragmentIsLostIsLost) {
  Pair pair(writer_config(ReliabilityKind::best_effort), reader_config(ReliabilityKind::best_effort));
  int next = 0;
  pair.world.medium = [&](const Sent&) { return ++next == 2 ? std::vector<sim::Duration>() : std::vector{1_ms}; };
  for (std::uint32_t i = 1; i <= 3; ++i) pair.write(i, 3000);
  pair.world.run_for(1_s);
  EXPECT_EQ(pair.take(), (Values{2, 3}));
}

}  // namespace
}  // namespace takt::dds
