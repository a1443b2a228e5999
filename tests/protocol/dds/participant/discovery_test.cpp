// SPDX-License-Identifier: Apache-2.0
// Participants that find each other: matches, leases, liveliness by participant messages, entities of one participant.
#include <gtest/gtest.h>

#include "world.hpp"

namespace takt::dds {
namespace {

using namespace sim::literals;
using Values = std::vector<std::uint32_t>;

ParticipantConfig finding(std::uint8_t number, DiscoveryKind kind = DiscoveryKind::simple) {
  ParticipantConfig config = World::config(number);
  config.discovery.emplace();
  config.discovery->kind = kind;
  config.name = "p" + std::to_string(number);
  return config;
}

TEST(DiscoveryInParticipants, MatchesAndDelivers) {
  World world;
  Participant& one = world.add(finding(1));
  Participant& two = world.add(finding(2));
  const WriterHandle writer = *one.create_writer(writer_config(), world.now).handle;
  const ReaderHandle reader = *two.create_reader(reader_config(), world.now).handle;
  world.run_for(100_ms);
  EXPECT_EQ(world.count(EventKind::participant_discovered, 0), 1u);
  EXPECT_EQ(world.count(EventKind::participant_discovered, 1), 1u);
  ASSERT_EQ(world.count(EventKind::matched, 0), 1u);
  ASSERT_EQ(world.count(EventKind::matched, 1), 1u);
  one.write(writer, no_key, payload_of(1), world.now);
  world.run_for(10_ms);
  EXPECT_EQ(drain_values(two, reader, world.now), (Values{1}));
  EXPECT_GT(one.discovery()->figures().sent().messages, 3u);
}

TEST(DiscoveryInParticipants, OfOtherDomainsDoNotMeet) {
  World world;
  Participant& one = world.add(finding(1));
  ParticipantConfig other = finding(2);
  other.domain = 1;
  Participant& two = world.add(other);
  EXPECT_TRUE(one.create_writer(writer_config(), world.now));
  EXPECT_TRUE(two.create_reader(reader_config(), world.now));
  world.run_for(100_s);
  EXPECT_EQ(world.count(EventKind::participant_discovered, 0), 0u);
  EXPECT_EQ(world.count(EventKind::matched, 1), 0u);
}

TEST(DiscoveryInParticipants, AnEntityThatComesAndGoesIsMatchedAndUnmatched) {
  World world;
  Participant& one = world.add(finding(1));
  Participant& two = world.add(finding(2));
  const ReaderHandle reader = *two.create_reader(reader_config(), world.now).handle;
  world.run_for(5_s);
  const WriterHandle writer = *one.create_writer(writer_config(), world.now).handle;
  world.run_for(1_s);
  EXPECT_EQ(world.count(EventKind::matched, 1), 1u);
  one.remove(writer, world.now);
  world.run_for(1_s);
  EXPECT_EQ(world.count(EventKind::unmatched, 1), 1u);
  EXPECT_EQ(two.reader(reader).matched.current_count, 0u);
}

TEST(DiscoveryInParticipants, TheEndOfTheLeaseEndsTheMatch) {
  World world;
  Participant& one = world.add(finding(1));
  Participant& two = world.add(finding(2));
  const WriterHandle writer = *one.create_writer(writer_config(), world.now).handle;
  EXPECT_TRUE(two.create_reader(reader_config(), world.now));
  world.run_for(5_s);
  one.write(writer, no_key, payload_of(1), world.now);
  world.kill(1);
  world.run_for(20_s);
  EXPECT_EQ(world.count(EventKind::participant_lost, 0), 1u);
  EXPECT_EQ(world.count(EventKind::unmatched, 0), 1u);
  EXPECT_EQ(one.writer(writer).rtps.matched(), 0u);
}

TEST(DiscoveryInParticipants, WhoTakesLeaveIsLostAtOnce) {
  World world;
  Participant& one = world.add(finding(1));
  world.add(finding(2));
  world.run_for(5_s);
  one.stop(world.now);
  world.run_for(1_ms);
  EXPECT_EQ(world.count(EventKind::participant_lost, 1), 1u);
}

TEST(DiscoveryInParticipants, IncompatibleQosIsToldAtBothEnds) {
  World world;
  Participant& one = world.add(finding(1));
  Participant& two = world.add(finding(2));
  EXPECT_TRUE(one.create_writer(writer_config(ReliabilityKind::best_effort), world.now));
  EXPECT_TRUE(two.create_reader(reader_config(), world.now));
  world.run_for(1_s);
  EXPECT_EQ(world.count(EventKind::incompatible_qos, 0), 1u);
  EXPECT_EQ(world.count(EventKind::incompatible_qos, 1), 1u);
}

TEST(DiscoveryInParticipants, ThroughAServer) {
  World world;
  ParticipantConfig serving = finding(9, DiscoveryKind::server);
  serving.metatraffic_port = discovery_server_port;
  world.add(serving);
  const auto client = [&](std::uint8_t number) {
    ParticipantConfig config = finding(number, DiscoveryKind::client);
    config.discovery->servers = {Locator::udp_v4(serving.address, discovery_server_port)};
    return config;
  };
  Participant& one = world.add(client(1));
  Participant& two = world.add(client(2));
  const WriterHandle writer = *one.create_writer(writer_config(), world.now).handle;
  const ReaderHandle reader = *two.create_reader(reader_config(), world.now).handle;
  world.run_for(5_s);
  one.write(writer, no_key, payload_of(7), world.now);
  world.run_for(10_ms);
  EXPECT_EQ(drain_values(two, reader, world.now), (Values{7}));
}

TEST(DiscoveryInParticipants, StaticallyByName) {
  World world;
  // Entities are numbered in the order of creation, so their names are known beforehand.
  ParticipantConfig one_config = finding(1, DiscoveryKind::static_);
  ParticipantConfig two_config = finding(2, DiscoveryKind::static_);
  SubscriptionData subscription;
  subscription.endpoint.guid.entity = EntityId::user(1, EntityKind::reader_no_key);
  subscription.endpoint.topic_name = "topic";
  subscription.endpoint.type_name = "Type";
  subscription.qos = reader_config().qos;
  PublicationData publication;
  publication.endpoint = subscription.endpoint;
  publication.endpoint.guid.entity = EntityId::user(1, EntityKind::writer_no_key);
  publication.qos = writer_config().qos;
  one_config.discovery->participants = {{"p2", {}, {subscription}}};
  two_config.discovery->participants = {{"p1", {publication}, {}}};
  Participant& one = world.add(one_config);
  Participant& two = world.add(two_config);
  const WriterHandle writer = *one.create_writer(writer_config(), world.now).handle;
  const ReaderHandle reader = *two.create_reader(reader_config(), world.now).handle;
  world.run_for(1_s);
  one.write(writer, no_key, payload_of(7), world.now);
  world.run_for(10_ms);
  EXPECT_EQ(drain_values(two, reader, world.now), (Values{7}));
  EXPECT_EQ(one.discovery()->figures().endpoints_sent.messages, 0u);
}

// A writer that writes nothing lives by its participant's messages, and dies with them.
TEST(DiscoveryInParticipants, AutomaticAndManualLivelinessByMessages) {
  for (const LivelinessKind kind : {LivelinessKind::automatic, LivelinessKind::manual_by_participant}) {
    World world;
    Participant& one = world.add(finding(1));
    Participant& two = world.add(finding(2));
    WriterConfig writing = writer_config();
    writing.qos.liveliness = {kind, 100_ms};
    ReaderConfig reading = reader_config();
    reading.qos.liveliness = {kind, 100_ms};
    const WriterHandle writer = *one.create_writer(writing, world.now).handle;
    const ReaderHandle reader = *two.create_reader(reading, world.now).handle;
    const auto status = [&] { return two.reader(reader).rtps.liveliness_changed(); };
    for (int i = 0; i < 40; ++i) {
      one.assert_liveliness(writer, world.now);  // of no effect where it is automatic
      world.run_for(50_ms);
    }
    EXPECT_EQ(status().alive_count, 1u);
    EXPECT_EQ(status().changes, 1u);  // the match
    if (kind == LivelinessKind::automatic) world.kill(0);
    world.run_for(200_ms);
    EXPECT_EQ(status().alive_count, 0u);
    EXPECT_EQ(status().not_alive_count, 1u);
  }
}

TEST(OneParticipant, ItsOwnEntitiesMatch) {
  for (const bool multicast : {false, true}) {
    World world;
    ParticipantConfig config = World::config(1);
    if (multicast) config.multicast_group = 0xEFFF0002;
    Participant& one = world.add(config);
    const WriterHandle writer = *one.create_writer(writer_config(), world.now).handle;
    const ReaderHandle reader = *one.create_reader(reader_config(), world.now).handle;
    for (std::uint32_t i = 1; i <= 3; ++i) one.write(writer, no_key, payload_of(i, 5000), world.now);
    world.run_for(10_s);
    EXPECT_EQ(drain_values(one, reader, world.now), (Values{1, 2, 3}));
    EXPECT_TRUE(one.writer(writer).rtps.is_acknowledged());
    EXPECT_TRUE(world.log.empty());
    one.remove(reader, world.now);
    EXPECT_EQ(one.writer(writer).rtps.matched(), 0u);
  }
}

}  // namespace
}  // namespace takt::dds
