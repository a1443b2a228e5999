// SPDX-License-Identifier: Apache-2.0
#include "pair.hpp"

namespace takt::dds {
namespace {

using namespace sim::literals;

/// Writer and reader with a lease of 100 ms of this kind.
struct Lively : Pair {
  explicit Lively(LivelinessKind kind) : Pair(with(kind), wanting(kind)) {
    world.run_for(5_ms);
    world.events.clear();
  }
  static WriterConfig with(LivelinessKind kind) {
    WriterConfig config = writer_config();
    config.qos.liveliness = {kind, 100_ms};
    return config;
  }
  static ReaderConfig wanting(LivelinessKind kind) {
    ReaderConfig config = reader_config();
    config.qos.liveliness = {kind, 200_ms};
    return config;
  }
  LivelinessChangedStatus status() const { return reading->reader(reader).rtps.liveliness_changed(); }
};

TEST(Liveliness, ByTopicEndsAtTheEndOfTheLease) {
  Lively pair(LivelinessKind::manual_by_topic);
  const sim::LocalTime written = pair.world.now;
  pair.write(1);
  pair.world.run_for(10_s);
  EXPECT_EQ(pair.status().alive_count, 0u);
  EXPECT_EQ(pair.status().not_alive_count, 1u);
  std::vector<std::pair<EventKind, sim::LocalTime>> told;
  for (const auto& [who, event] : pair.world.events)
    if (event.kind == EventKind::liveliness_lost || event.kind == EventKind::liveliness_changed)
      told.emplace_back(event.kind, event.at);
  EXPECT_EQ(told, (std::vector<std::pair<EventKind, sim::LocalTime>>{
                      {EventKind::liveliness_lost, written + 100_ms},
                      {EventKind::liveliness_changed, written + 100_us + 100_ms}}));
  pair.write(2);
  pair.world.run_for(1_ms);
  EXPECT_EQ(pair.status().alive_count, 1u);
}

TEST(Liveliness, ByTopicIsAssertedByHand) {
  Lively pair(LivelinessKind::manual_by_topic);
  for (int i = 0; i < 20; ++i) {
    pair.writing->assert_liveliness(pair.writer, pair.world.now);
    pair.world.run_for(90_ms);
  }
  EXPECT_EQ(pair.world.count(EventKind::liveliness_lost, 0), 0u);
  EXPECT_EQ(pair.world.count(EventKind::liveliness_changed, 1), 0u);
}

TEST(Liveliness, OfAnOwnerThatIsLostHandsTheInstanceOver) {
  WriterConfig strong = Lively::with(LivelinessKind::manual_by_topic);
  ReaderConfig reading = Lively::wanting(LivelinessKind::manual_by_topic);
  strong.qos.ownership.kind = reading.qos.ownership.kind = OwnershipKind::exclusive;
  strong.qos.ownership_strength.value = 5;
  Pair pair(strong, reading);
  WriterConfig weak = strong;
  weak.qos.ownership_strength.value = 1;
  const WriterHandle second = *pair.writing->create_writer(weak, pair.world.now).handle;
  pair.world.match(*pair.writing, second, *pair.reading, pair.reader);
  const auto write_weak = [&](std::uint32_t value) {
    pair.writing->write(second, no_key, payload_of(value), pair.world.now);
    pair.world.run_for(1_ms);
  };
  pair.write(1);
  pair.world.run_for(1_ms);
  write_weak(2);
  EXPECT_EQ(pair.take(), (std::vector<std::uint32_t>{1}));
  pair.world.run_for(200_ms);
  write_weak(3);
  EXPECT_EQ(pair.take(), (std::vector<std::uint32_t>{3}));
}

TEST(Deadline, IsToldAtBothEnds) {
  WriterConfig writing = writer_config();
  writing.qos.deadline.period = 10_ms;
  ReaderConfig reading = reader_config();
  reading.qos.deadline.period = 20_ms;
  Pair pair(writing, reading);
  const sim::LocalTime written = pair.world.now;
  pair.write(1);
  pair.world.events.clear();
  pair.world.run_for(25_ms);
  std::vector<std::tuple<std::size_t, sim::LocalTime, std::uint64_t>> told;
  for (const auto& [who, event] : pair.world.events)
    if (event.kind == EventKind::deadline_missed) told.emplace_back(who, event.at, event.count);
  EXPECT_EQ(told, (std::vector<std::tuple<std::size_t, sim::LocalTime, std::uint64_t>>{
                      {0, written + 10_ms, 1}, {0, written + 20_ms, 2}, {1, written + 100_us + 20_ms, 1}}));
}

}  // namespace
}  // namespace takt::dds
