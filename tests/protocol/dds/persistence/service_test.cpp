// SPDX-License-Identifier: Apache-2.0
// The persistence service: what late readers get when the writers are gone.
#include <gtest/gtest.h>

#include "dds/participant/world.hpp"
#include "dds/persistence/persistence_service.hpp"

namespace takt::dds {
namespace {

using namespace sim::literals;
using Values = std::vector<std::uint32_t>;

constexpr InstanceKey a{1};
constexpr InstanceKey b{2};

/// Participants that find each other; the service has one of them.
struct Site {
  explicit Site(DurabilityKind durability, std::int32_t depth = 1) {
    topic.topic = "topic";
    topic.type = "Type";
    topic.has_key = true;
    topic.qos.durability.kind = durability;
    topic.qos.durability_service.history.depth = depth;
    start_service();
  }
  Participant& come(std::size_t* index = nullptr) {
    ParticipantConfig config = World::config(++incarnations);
    config.discovery.emplace();
    Participant& participant = world.add(config);
    if (index != nullptr) *index = world.participants.size() - 1;
    return participant;
  }
  void start_service() {
    if (service) {
      service.reset();
      world.kill(service_at);
    }
    Participant& participant = come(&service_at);
    service = std::make_unique<PersistenceService>(participant, storage, GuidPrefix{{0xCC}});
    EXPECT_EQ(service->add(topic, world.now), std::vector<std::string>());
  }
  void run_for(sim::Duration duration) {
    const sim::LocalTime end = world.now + duration;
    do {
      service->run(world.now);
      world.collect();
      if (service->next_wake() < world.next() && service->next_wake() <= end)
        world.now = std::max(world.now, service->next_wake());
      else if (!world.step(end))
        break;
    } while (true);
    world.now = end;
  }
  WriterHandle writer_of(Participant& participant, DurabilityKind durability, std::int32_t depth = 1) {
    WriterConfig config = writer_config();
    config.qos.history.depth = depth;
    config.has_key = true;
    config.qos.durability.kind = durability;
    return *participant.create_writer(config, world.now).handle;
  }
  ReaderHandle reader_of(Participant& participant, DurabilityKind durability) {
    ReaderConfig config = reader_config();
    config.has_key = true;
    config.qos.durability.kind = durability;
    return *participant.create_reader(config, world.now).handle;
  }
  /// What a reader that comes now gets.
  Values late(DurabilityKind durability) {
    Participant& reading = come();
    const ReaderHandle reader = reader_of(reading, durability);
    run_for(10_s);
    return drain_values(reading, reader, world.now);
  }

  World world;
  MemoryStorage storage;
  DurableTopic topic;
  std::unique_ptr<PersistenceService> service;
  std::size_t service_at = 0;
  std::uint8_t incarnations = 0;
};

TEST(PersistenceService, BringsTheLastStatesWhenTheWriterIsGone) {
  Site site(DurabilityKind::transient);
  std::size_t at = 0;
  Participant& writing = site.come(&at);
  const WriterHandle writer = site.writer_of(writing, DurabilityKind::transient);
  site.run_for(5_s);
  for (const auto& [key, value] : {std::pair(a, 1u), {b, 2u}, {a, 3u}})
    writing.write(writer, key, payload_of(value), site.world.now);
  site.run_for(5_s);
  EXPECT_EQ(site.service->kept("topic"), 2u);
  site.world.kill(at);
  site.run_for(30_s);
  EXPECT_EQ(site.late(DurabilityKind::transient), (Values{2, 3}));
  EXPECT_EQ(site.late(DurabilityKind::transient_local), Values());  // needs the writer itself
  EXPECT_EQ(site.late(DurabilityKind::volatile_), Values());
  EXPECT_EQ(site.late(DurabilityKind::persistent), Values());  // asks for more than is offered
}

TEST(PersistenceService, TellsWhoWroteIt) {
  Site site(DurabilityKind::transient);
  std::size_t at = 0;
  Participant& writing = site.come(&at);
  const WriterHandle writer = site.writer_of(writing, DurabilityKind::transient);
  const Guid guid = writing.data_of(writer).endpoint.guid;
  site.run_for(5_s);
  const sim::LocalTime written = site.world.now;
  writing.write(writer, a, payload_of(1), written);
  site.run_for(5_s);
  site.world.kill(at);
  site.run_for(30_s);
  Participant& reading = site.come();
  const ReaderHandle reader = site.reader_of(reading, DurabilityKind::transient);
  site.run_for(5_s);
  const std::optional<Sample> sample = reading.take(reader, site.world.now);
  ASSERT_TRUE(sample);
  EXPECT_EQ(sample->info.writer, guid);
  EXPECT_EQ(sample->info.number, SequenceNumber{1});
  EXPECT_EQ(sample->info.source_timestamp, written);
}

TEST(PersistenceService, WhatTheWriterBringsItselfComesOnce) {
  Site site(DurabilityKind::transient, 10);
  Participant& writing = site.come();
  Participant& reading = site.come();
  const WriterHandle writer = site.writer_of(writing, DurabilityKind::transient);
  const ReaderHandle reader = site.reader_of(reading, DurabilityKind::transient);
  site.run_for(5_s);
  Values written;
  for (std::uint32_t i = 1; i <= 20; ++i) {
    writing.write(writer, i % 2 == 0 ? a : b, payload_of(i), site.world.now);
    site.run_for(1_ms);
    written.push_back(i);
  }
  site.run_for(5_s);
  EXPECT_EQ(drain_values(reading, reader, site.world.now), written);
  EXPECT_GT(reading.reader(reader).rtps.duplicates(), 0u);  // of the service
  // The last one of each instance is the writer's; what is older only the service has.
  Values late = site.late(DurabilityKind::transient);
  std::sort(late.begin(), late.end());
  EXPECT_EQ(late, written);
}

TEST(PersistenceService, OnlyPersistentTopicsSurviveItsRestart) {
  for (const DurabilityKind durability : {DurabilityKind::transient, DurabilityKind::persistent}) {
    Site site(durability);
    std::size_t at = 0;
    Participant& writing = site.come(&at);
    const WriterHandle writer = site.writer_of(writing, durability);
    site.run_for(5_s);
    for (std::uint32_t i = 1; i <= 3; ++i) writing.write(writer, a, payload_of(i), site.world.now);
    site.run_for(5_s);
    site.world.kill(at);
    site.run_for(30_s);
    site.start_service();
    site.run_for(30_s);
    EXPECT_EQ(site.late(durability), durability == DurabilityKind::persistent ? (Values{3}) : Values());
  }
}

TEST(PersistenceService, ARestartTakesNothingTwice) {
  Site site(DurabilityKind::persistent, 10);
  Participant& writing = site.come();
  Participant& reading = site.come();
  const WriterHandle writer = site.writer_of(writing, DurabilityKind::persistent);
  const ReaderHandle reader = site.reader_of(reading, DurabilityKind::persistent);
  site.run_for(5_s);
  for (std::uint32_t i = 1; i <= 3; ++i) {
    writing.write(writer, a, payload_of(i), site.world.now);
    site.run_for(5_s);
    site.start_service();  // gets the last one from its writer again
    site.run_for(5_s);
    EXPECT_EQ(site.service->kept("topic"), i);
  }
  EXPECT_EQ(drain_values(reading, reader, site.world.now), (Values{1, 2, 3}));
}

// A writer that is alive brings its whole history to a service that starts again; what was replaced must not come back.
TEST(PersistenceService, ARestartKeepsTheNewest) {
  Site site(DurabilityKind::persistent, 1);
  std::size_t at = 0;
  Participant& writing = site.come(&at);
  const WriterHandle writer = site.writer_of(writing, DurabilityKind::persistent, 3);
  site.run_for(5_s);
  for (std::uint32_t i = 1; i <= 3; ++i) writing.write(writer, a, payload_of(i), site.world.now);
  site.run_for(5_s);
  site.start_service();
  site.run_for(5_s);
  site.world.kill(at);
  site.run_for(30_s);
  EXPECT_EQ(site.late(DurabilityKind::persistent), (Values{3}));
}

TEST(PersistenceService, CleansUpWhatWasDisposed) {
  Site site(DurabilityKind::transient);
  site.topic.topic = "slow";
  site.topic.qos.durability_service.service_cleanup_delay = 10_s;
  EXPECT_EQ(site.service->add(site.topic, site.world.now), std::vector<std::string>());
  Participant& writing = site.come();
  WriterConfig config = writer_config();
  config.has_key = true;
  config.topic = "slow";
  config.qos.durability.kind = DurabilityKind::transient;
  const WriterHandle writer = *writing.create_writer(config, site.world.now).handle;
  site.run_for(5_s);
  writing.write(writer, a, payload_of(1), site.world.now);
  writing.write(writer, b, payload_of(2), site.world.now);
  site.run_for(1_s);
  writing.dispose(writer, a, site.world.now);
  site.run_for(9_s);
  EXPECT_EQ(site.service->kept("slow"), 2u);  // of a that it was disposed
  site.run_for(2_s);
  EXPECT_EQ(site.service->kept("slow"), 1u);
}

TEST(PersistenceService, RefusesWhatItCannotKeep) {
  Site site(DurabilityKind::transient);
  using Problems = std::vector<std::string>;
  EXPECT_EQ(site.service->add(site.topic, start), (Problems{"topic: topic is kept already"}));
  site.topic.topic = "other";
  site.topic.qos.ownership.kind = OwnershipKind::exclusive;
  EXPECT_EQ(site.service->add(site.topic, start),
            (Problems{"ownership: EXCLUSIVE is not supported by the persistence service"}));
  site.topic.qos.durability.kind = DurabilityKind::transient_local;
  EXPECT_EQ(site.service->add(site.topic, start),
            (Problems{"durability: a persistence service keeps topics that are TRANSIENT or PERSISTENT"}));
}

}  // namespace
}  // namespace takt::dds
