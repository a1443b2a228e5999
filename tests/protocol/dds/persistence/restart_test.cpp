// SPDX-License-Identifier: Apache-2.0
// Writers and readers that are killed and start again under their persistence GUID.
#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <rapidcheck/gtest.h>

#include "dds/participant/world.hpp"
#include "sim/random.hpp"

namespace takt::dds {
namespace {

using namespace sim::literals;
using Values = std::vector<std::uint32_t>;

const Guid writer_name{{{0xAA}}, EntityId::user(1, EntityKind::writer_no_key)};
const Guid reader_name{{{0xBB}}, EntityId::user(1, EntityKind::reader_no_key)};

WriterConfig persistent_writer(Storage& storage, std::int32_t max_samples = unlimited) {
  WriterConfig config = writer_config();
  config.qos.durability.kind = DurabilityKind::persistent;
  config.qos.history.kind = HistoryKind::keep_all;
  config.qos.resource_limits.max_samples = max_samples;
  config.qos.reliability.max_blocking_time = infinite;
  config.persistence_guid = writer_name;
  config.storage = &storage;
  return config;
}
ReaderConfig durable_reader() {
  ReaderConfig config = reader_config();
  config.qos.durability.kind = DurabilityKind::persistent;
  return config;
}
ReaderConfig persistent_reader(Storage& storage) {
  ReaderConfig config = durable_reader();
  config.persistence_guid = reader_name;
  config.storage = &storage;
  return config;
}

/// A writer that writes its own numbers, and dies and comes back; a reader that does the same.
struct Restarts {
  explicit Restarts(std::uint64_t seed) : chance(seed, "medium", "restarts") {
    world.keeps_log = false;
    world.medium = [this](const Sent&) {
      std::vector<sim::Duration> delays;
      const auto delay = [&] {
        return sim::Duration::from_ps(static_cast<std::int64_t>(50'000'000 + chance.below(3'000'000'000)));
      };
      if (chance.below(100) >= 20) delays.push_back(delay());
      if (chance.below(100) < 20) delays.push_back(delay());
      return delays;
    };
  }
  Participant& come(std::size_t& index) {
    ParticipantConfig config = World::config(++incarnations);
    Participant& participant = world.add(config);
    index = world.participants.size() - 1;
    return participant;
  }
  void start_writer(std::int32_t max_samples) {
    const Guid old = writing == nullptr ? Guid() : writing->data_of(writer).endpoint.guid;
    if (writing != nullptr) world.kill(writer_at);
    writing = &come(writer_at);
    writer = *writing->create_writer(persistent_writer(writer_storage, max_samples), world.now).handle;
    written = static_cast<std::uint32_t>(writing->writer(writer).rtps.history().last().value);
    blocked = false;
    if (reading == nullptr) return;
    world.match(*writing, writer, *reading, reader);
    // Sooner or later the reader finds out that the old one is gone.
    if (!old.is_unknown() && chance.below(2) == 0) reading->unmatch(reader, old, world.now);
  }
  void start_reader(bool keeps) {
    const Guid old = reading == nullptr ? Guid() : reading->data_of(reader).endpoint.guid;
    if (reading != nullptr) world.kill(reader_at);
    reading = &come(reader_at);
    reader = *reading->create_reader(keeps ? persistent_reader(reader_storage) : durable_reader(), world.now).handle;
    if (!old.is_unknown()) writing->unmatch(writer, old, world.now);
    world.match(*writing, writer, *reading, reader);
  }
  void write(std::uint32_t most) {
    while (written < most && !blocked) {
      if (writing->write(writer, no_key, payload_of(written + 1), world.now).verdict == WriteVerdict::written)
        ++written;
      else
        blocked = true;
      if (chance.below(3) == 0) break;
    }
    world.collect();
  }
  void pass() {
    world.run_for(sim::Duration::from_ps(static_cast<std::int64_t>(chance.below(8'000'000'000))));
    for (const auto& [who, event] : world.events)
      if (event.kind == EventKind::writable && who == writer_at) blocked = false;
    world.events.clear();
    for (std::uint64_t n = chance.below(4); n > 0; --n)
      if (const std::optional<Sample> sample = reading->take(reader, world.now); sample && sample->info.valid_data)
        taken.push_back(value_of(*sample).value_or(0xDEAD));
  }

  sim::RandomStream chance;
  World world;
  MemoryStorage writer_storage;
  MemoryStorage reader_storage;
  std::uint8_t incarnations = 0;
  Participant* writing = nullptr;
  Participant* reading = nullptr;
  std::size_t writer_at = 0;
  std::size_t reader_at = 0;
  WriterHandle writer;
  ReaderHandle reader;
  std::uint32_t written = 0;
  bool blocked = false;
  Values taken;
};

Values up_to(std::uint32_t last) {
  Values values;
  for (std::uint32_t i = 1; i <= last; ++i) values.push_back(i);
  return values;
}

RC_GTEST_PROP(Restart, OfTheWriterLosesAndRepeatsNothing, ()) {
  Restarts run(*rc::gen::inRange<std::uint64_t>(0, 1'000'000'000));
  const auto limit = *rc::gen::inRange<std::int32_t>(1, 6);
  constexpr std::uint32_t samples = 20;
  run.start_writer(limit);
  run.start_reader(false);
  int restarts = 3;
  for (int i = 0; i < 400'000 && run.taken.size() < samples; ++i) {
    run.write(samples);
    run.pass();
    if (restarts > 0 && run.chance.below(12) == 0) {
      --restarts;
      run.start_writer(limit);
    }
  }
  RC_ASSERT(run.taken == up_to(samples));
}

RC_GTEST_PROP(Restart, OfBothLosesAndRepeatsNothing, ()) {
  Restarts run(*rc::gen::inRange<std::uint64_t>(0, 1'000'000'000));
  constexpr std::uint32_t samples = 20;
  run.start_writer(unlimited);
  run.start_reader(true);
  int restarts = 6;
  for (int i = 0; i < 400'000 && run.taken.size() < samples; ++i) {
    run.write(samples);
    run.pass();
    if (restarts == 0 || run.chance.below(8) != 0) continue;
    --restarts;
    run.chance.below(2) == 0 ? run.start_writer(unlimited) : run.start_reader(true);
  }
  RC_ASSERT(run.taken == up_to(samples));
}

TEST(Restart, WithoutAStorageNumbersBeginAgain) {
  MemoryStorage storage;
  World world;
  Participant& first = world.add();
  const WriterHandle writer = *first.create_writer(persistent_writer(storage), start).handle;
  EXPECT_EQ(first.write(writer, no_key, payload_of(1), start).number, SequenceNumber{1});
  Participant& second = world.add();
  const WriterHandle again = *second.create_writer(persistent_writer(storage), start).handle;
  EXPECT_EQ(second.write(again, no_key, payload_of(2), start).number, SequenceNumber{2});
  const WriterHandle other = *second.create_writer(writer_config(), start).handle;
  EXPECT_EQ(second.write(other, no_key, payload_of(2), start).number, SequenceNumber{1});
}

/// A reader hears one sample of each of `restarts` writers, each under a GUID of its own, and takes it when its writer
/// is gone.
struct ManyWriters {
  explicit ManyWriters(bool have_a_name) {
    StatefulReader::Settings settings;
    settings.tracks_delivered = true;
    settings.history.history.keep_all = true;
    StatefulReader reader(settings);
    Outbox outbox({}, 1472);
    for (std::uint32_t i = 0; i < restarts; ++i) {
      MatchedWriter writer;
      writer.guid = {{{1, static_cast<std::uint8_t>(i >> 8), static_cast<std::uint8_t>(i)}},
                     EntityId::user(1, EntityKind::writer_no_key)};
      if (have_a_name) writer.persistence_guid = writer_name;
      reader.match(writer, start);
      const std::vector<std::byte> payload = payload_of(i);
      Data data;
      data.sequence_number = {static_cast<std::int64_t>(i) + 1};
      data.payload_kind = PayloadKind::data;
      data.payload = payload;
      reader.receive(writer.guid, data, std::nullopt, start, outbox);
      reader.unmatch(writer.guid, start);
      most = std::max(most, reader.remembered());
      const std::optional<Sample> sample = reader.take(start, outbox);
      if (!sample || !sample->info.valid_data) continue;
      ++taken;
      named += sample->info.identity == (have_a_name ? writer_name : writer.guid) ? 1 : 0;
      while (reader.take(start, outbox)) {  // that the writer has gone
      }
    }
  }
  static constexpr std::uint32_t restarts = 5000;
  std::uint32_t taken = 0;
  std::uint32_t named = 0;
  std::size_t most = 0;
};

TEST(Restart, AsOftenAsItMayBeTheReaderRemembersNoMore) {
  const ManyWriters named(true);
  EXPECT_EQ(named.taken, ManyWriters::restarts);
  EXPECT_EQ(named.named, ManyWriters::restarts);
  EXPECT_EQ(named.most, 1u);
  const ManyWriters nameless(false);
  EXPECT_EQ(nameless.taken, ManyWriters::restarts);
  EXPECT_EQ(nameless.named, ManyWriters::restarts);
  EXPECT_EQ(nameless.most, StatefulReader::most_remembered + 1);  // with the one that is matched
}

}  // namespace
}  // namespace takt::dds
