// SPDX-License-Identifier: Apache-2.0
// Data of discovery: round trips with every policy, what is refused, and what a stock implementation sends.
#include "dds/discovery/data.hpp"

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include "dds/dissector.hpp"
#include "dds/message/decoder.hpp"
#include "dds/message/encoder.hpp"
#include "dds/octets.hpp"

namespace takt::dds {
namespace {

using namespace test;
using namespace sim::literals;

constexpr GuidPrefix prefix{{0x01, 0xFA, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10}};
constexpr Guid participant{prefix, entity_id::participant};
constexpr Guid writer{prefix, EntityId::user(1, EntityKind::writer_with_key)};
constexpr Guid reader{prefix, EntityId::user(2, EntityKind::reader_with_key)};

template <class Data>
std::vector<std::byte> octets(const Data& data) {
  std::vector<std::byte> buffer(16'384);
  return copy(encode(buffer, data));
}

template <class Data>
::testing::AssertionResult survives(const Data& data) {
  Data again;
  const DataVerdict verdict = decode(octets(data), again);
  if (verdict != DataVerdict::ok) return ::testing::AssertionFailure() << name_of(verdict);
  if (again != data) return ::testing::AssertionFailure() << "another value";
  return ::testing::AssertionSuccess();
}

ParticipantData some_participant() {
  ParticipantData data;
  data.guid = participant;
  data.domain = 3;
  data.lease_duration = 20_s;
  data.metatraffic_unicast = {Locator::udp_v4(0x0A000001, 7410)};
  data.metatraffic_multicast = {Locator::udp_v4(discovery_group, 7400)};
  data.default_unicast = {Locator::udp_v4(0x0A000001, 7411), Locator::udp_v4(0x0A000101, 7411)};
  data.default_multicast = {Locator::udp_v4(discovery_group, 7401)};
  data.manual_liveliness_count = 4;
  data.expects_inline_qos = true;
  data.entity_name = "diagnose node";
  data.user_data.octets = octets_of("010203");
  return data;
}

/// All policies that both have, none at its default.
template <class Qos>
void change_all(Qos& qos) {
  qos.reliability = {
      qos.reliability.kind == ReliabilityKind::reliable ? ReliabilityKind::best_effort : ReliabilityKind::reliable,
      7_ms};
  qos.durability.kind = DurabilityKind::persistent;
  qos.history = {HistoryKind::keep_all, 9};
  qos.resource_limits = {100, 10, 50};
  qos.deadline.period = 1_ms;
  qos.latency_budget.duration = 2_us;
  qos.liveliness = {LivelinessKind::manual_by_topic, 3_s};
  qos.ownership.kind = OwnershipKind::exclusive;
  qos.destination_order.kind = DestinationOrderKind::by_source_timestamp;
  qos.presentation = {PresentationScope::group, true, false};
  qos.partition.names = {"a", "cell*", "", "four"};
  qos.user_data.octets = octets_of("01");
  qos.topic_data.octets = octets_of("010203040506");
  qos.group_data.octets = octets_of("ff");
}

PublicationData some_publication() {
  PublicationData data;
  data.endpoint.guid = writer;
  data.endpoint.participant = participant;
  data.endpoint.topic_name = "Topic";
  data.endpoint.type_name = "module::Type";
  data.endpoint.unicast = {Locator::udp_v4(0x0A000001, 7411)};
  data.endpoint.multicast = {Locator::udp_v4(0xEFFF0005, 7401)};
  data.endpoint.representations = {DataRepresentation::xcdr1, DataRepresentation::xcdr2};
  data.endpoint.type_max_size = 1000;
  data.endpoint.persistence_guid = {{{9}}, {77}};
  data.endpoint.entity_name = "valve";
  change_all(data.qos);
  data.qos.durability_service = {4_s, {HistoryKind::keep_all, 3}, {7, 6, 5}};
  data.qos.ownership_strength.value = -5;
  data.qos.lifespan.duration = 10_s;
  data.qos.transport_priority.value = 46;
  return data;
}

SubscriptionData some_subscription() {
  SubscriptionData data;
  data.endpoint.guid = reader;
  data.endpoint.topic_name = "Topic";
  data.endpoint.type_name = "module::Type";
  change_all(data.qos);
  data.qos.time_based_filter.minimum_separation = 5_ms;
  data.expects_inline_qos = true;
  return data;
}

TEST(Data, RoundTrips) {
  EXPECT_TRUE(survives(some_participant()));
  EXPECT_TRUE(survives(some_publication()));
  EXPECT_TRUE(survives(some_subscription()));
  EXPECT_TRUE(survives(ParticipantMessageData{prefix, ParticipantMessageData::Kind::manual, octets_of("00")}));
}

TEST(Data, RoundTripsOfDefaults) {
  ParticipantData bare;
  bare.guid = participant;
  EXPECT_TRUE(survives(bare));
  PublicationData publication;
  publication.endpoint.guid = writer;
  publication.endpoint.topic_name = publication.endpoint.type_name = "T";
  EXPECT_TRUE(survives(publication));
  SubscriptionData subscription;
  subscription.endpoint = publication.endpoint;
  EXPECT_TRUE(survives(subscription));
}

TEST(Data, OfAParticipantByHand) {
  ParticipantData data;
  data.guid = participant;
  data.lease_duration = 10_s;
  data.metatraffic_unicast = {Locator::udp_v4(0x0A000001, 7410)};
  EXPECT_EQ(hex_of(octets(data)),
            "00030000"
            "15000400"
            "02010000"
            "16000400"
            "01fa0000"
            "02000800"
            "0a00000000000000"
            "50001000"
            "01fa0102030405060708090a000001c1"
            "58000400"
            "3f0c0000"
            "32001800"
            "01000000"
            "f21c0000"
            "0000000000000000000000000a000001"
            "01000000");
}

TEST(Data, OfAParticipantMessageByHand) {
  EXPECT_EQ(hex_of(octets(ParticipantMessageData{prefix, ParticipantMessageData::Kind::automatic, octets_of("00")})),
            "00010003"
            "01fa0102030405060708090a"
            "00000001"
            "01000000"
            "00000000");
}

TEST(Data, Keys) {
  for (const Guid& guid : {participant, writer}) {
    std::vector<std::byte> buffer(64);
    const Octets key = encode_key(buffer, guid);
    EXPECT_EQ(key.size(), 4u + 20u + 4u);
    Guid again;
    EXPECT_EQ(decode_key(key, again), DataVerdict::ok);
    EXPECT_EQ(again, guid);
    EXPECT_EQ(guid_of(key_hash_of(guid)), guid);
  }
}

TEST(Data, Refusals) {
  ParticipantData data;
  const auto verdict = [&](const std::string& hex) { return name_of(decode(octets_of(hex), data)); };
  const std::string guid =
      "50001000"
      "01fa0102030405060708090a000001c1";
  EXPECT_EQ(verdict(""), "truncated");
  EXPECT_EQ(verdict("00010000"
                    "01000000"),
            "representation");
  EXPECT_EQ(verdict("000b0000"
                    "01000000"),
            "representation");
  EXPECT_EQ(verdict("00030000"
                    "01000000"),
            "incomplete");
  EXPECT_EQ(verdict("00030000" + guid), "truncated") << "no sentinel";
  EXPECT_EQ(verdict("00030000" + guid + "01000000"), "ok");
  EXPECT_EQ(verdict("00030000" + guid +
                    "ff3f0400"
                    "00000000"
                    "01000000"),
            "ok")
      << "not known";
  EXPECT_EQ(verdict("00030000" + guid +
                    "ff7f0400"
                    "00000000"
                    "01000000"),
            "not_understood");
  EXPECT_EQ(verdict("00030000" + guid +
                    "ffff0400"
                    "00000000"
                    "01000000"),
            "ok")
      << "a vendor's own";
  EXPECT_EQ(verdict("00030000" + guid +
                    "02000400"
                    "0a000000"
                    "01000000"),
            "malformed")
      << "half a lease";
  PublicationData publication;
  const auto of_writer = [&](const std::string& hex) {
    return name_of(decode(octets_of("00030000" + hex + "01000000"), publication));
  };
  EXPECT_EQ(of_writer("1a000c00"
                      "03000000"
                      "0000000000000000"),
            "malformed")
      << "reliability 3";
  EXPECT_EQ(of_writer("29000400"
                      "ffffffff"),
            "malformed")
      << "4 thousand million partitions";
  EXPECT_EQ(of_writer("05000800"
                      "02000000"
                      "41420000"),
            "malformed")
      << "a name without an end";
  EXPECT_EQ(of_writer("05000800"
                      "02000000"
                      "41000000"),
            "incomplete");
}

// What is left out has its default value, also where the standard's default is not that of both.
TEST(Data, WhatIsNotToldHasItsDefault) {
  const std::string names =
      "05000800"
      "02000000"
      "41000000"
      "07000800"
      "02000000"
      "41000000"
      "5a001000"
      "01fa0102030405060708090a00000102";
  PublicationData publication;
  ASSERT_EQ(decode(octets_of("00030000" + names + "01000000"), publication), DataVerdict::ok);
  EXPECT_EQ(publication.qos, DataWriterQos{});
  SubscriptionData subscription;
  ASSERT_EQ(decode(octets_of("00030000" + names + "01000000"), subscription), DataVerdict::ok);
  EXPECT_EQ(subscription.qos, DataReaderQos{});
}

TEST(Data, RoundTripOfWhateverIsDrawn) {
  EXPECT_TRUE(rc::check("publications survive", [] {
    PublicationData data = some_publication();
    data.endpoint.topic_name = *rc::gen::nonEmpty(rc::gen::container<std::string>(rc::gen::inRange<char>(32, 127)));
    data.qos.partition.names =
        *rc::gen::container<std::vector<std::string>>(rc::gen::container<std::string>(rc::gen::inRange<char>(32, 127)));
    // Whole nanoseconds survive; what is longer than 106 days is infinite.
    data.qos.deadline.period = sim::Duration::from_ps(*rc::gen::inRange<std::int64_t>(0, 9'000'000'000'000'000) * 1000);
    data.qos.history.depth = *rc::gen::arbitrary<std::int32_t>();
    data.qos.resource_limits.max_samples = *rc::gen::arbitrary<std::int32_t>();
    data.endpoint.unicast.assign(*rc::gen::inRange<std::size_t>(0, 5),
                                 Locator::udp_v4(*rc::gen::arbitrary<std::uint32_t>(), 7411));
    RC_ASSERT(static_cast<bool>(survives(data)));
  }));
}

TEST(Data, DamageIsHarmless) {
  const std::vector<std::vector<std::byte>> seeds = {octets(some_participant()), octets(some_publication()),
                                                     octets(some_subscription()),
                                                     octets(ParticipantMessageData{prefix, {}, octets_of("00")})};
  std::uint64_t state = 1;
  const auto draw = [&] { return (state = state * 6364136223846793005U + 1442695040888963407U) >> 33; };
  std::size_t sound = 0;
  for (int i = 0; i < 40'000; ++i) {
    std::vector<std::byte> damaged = seeds[draw() % seeds.size()];
    for (std::uint64_t k = draw() % 4; k != 0; --k)
      damaged[draw() % damaged.size()] = static_cast<std::byte>(draw() & 0xFF);
    if (draw() % 4 == 0) damaged.resize(draw() % damaged.size());
    damaged.shrink_to_fit();
    ParticipantData a;
    PublicationData b;
    SubscriptionData c;
    ParticipantMessageData d;
    Guid e;
    sound += decode(damaged, a) == DataVerdict::ok || decode(damaged, b) == DataVerdict::ok ||
             decode(damaged, c) == DataVerdict::ok;
    sound += decode(damaged, d) == DataVerdict::ok || decode_key(damaged, e) == DataVerdict::ok;
  }
  EXPECT_GT(sound, 10'000u);
}

// What two participants of Cyclone DDS 0.10.2 say to each other (tests/golden/dds).
TEST(Data, OfAStockImplementation) {
  std::vector<ParticipantData> participants;
  std::vector<PublicationData> publications;
  std::vector<SubscriptionData> subscriptions;
  std::vector<ParticipantMessageData> messages;
  std::vector<Guid> disposed;
  for (const Datagram& datagram :
       read_pcap(std::string(TAKT_SOURCE_DIR) + "/tests/golden/dds/cyclone-two-participants.pcap")) {
    if (datagram.payload.size() < message_header_size) continue;  // Cyclone wakes its own threads so
    MessageDecoder decoder(datagram.payload);
    while (decoder.next()) {
      const auto* const data = std::get_if<Data>(&decoder.submessage());
      if (data == nullptr || !data->writer.is_built_in()) continue;
      if (data->payload_kind == PayloadKind::key) {
        EXPECT_EQ(data->inline_qos.status_info, status_info::disposed | status_info::unregistered);
        EXPECT_EQ(decode_key(data->payload, disposed.emplace_back()), DataVerdict::ok);
      } else if (data->writer == entity_id::spdp_writer) {
        EXPECT_EQ(decode(data->payload, participants.emplace_back()), DataVerdict::ok);
      } else if (data->writer == entity_id::sedp_publications_writer) {
        EXPECT_EQ(decode(data->payload, publications.emplace_back()), DataVerdict::ok);
      } else if (data->writer == entity_id::sedp_subscriptions_writer) {
        EXPECT_EQ(decode(data->payload, subscriptions.emplace_back()), DataVerdict::ok);
      } else if (data->writer == entity_id::participant_message_writer) {
        EXPECT_EQ(decode(data->payload, messages.emplace_back()), DataVerdict::ok);
      }
    }
    EXPECT_EQ(decoder.verdict(), MessageStatus::ok);
    EXPECT_EQ(decoder.skipped(), 0u);
  }
  ASSERT_EQ(participants.size(), 5u);
  EXPECT_EQ(participants[0].vendor.value, 0x0110);
  EXPECT_EQ(participants[0].lease_duration, 10_s);
  EXPECT_EQ(participants[0].domain, 0u);
  EXPECT_EQ(participants[0].builtin_endpoints & 0xFFFU, 0xC3Fu);
  EXPECT_EQ(participants[0].metatraffic_multicast, std::vector{Locator::udp_v4(discovery_group, 7400)});
  ASSERT_EQ(publications.size(), 1u);
  ASSERT_EQ(subscriptions.size(), 1u);
  EXPECT_EQ(publications[0].endpoint.type_name, "TaktInterop::Sample");
  EXPECT_EQ(publications[0].qos.reliability, (Reliability{ReliabilityKind::reliable, 1_s}));
  EXPECT_EQ(subscriptions[0].qos.history.kind, HistoryKind::keep_all);
  EXPECT_EQ(match(publications[0], subscriptions[0]).reason, "");
  ASSERT_EQ(messages.size(), 2u);
  EXPECT_EQ(messages[0].kind, ParticipantMessageData::Kind::automatic);
  EXPECT_EQ(disposed.size(), 3u) << "the reader and both participants; the publisher's program ended after it had left";
}

}  // namespace
}  // namespace takt::dds
