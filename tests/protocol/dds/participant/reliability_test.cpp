// SPDX-License-Identifier: Apache-2.0
// What writers and readers send, message by message.
#include "pair.hpp"

namespace takt::dds {
namespace {

using namespace sim::literals;
using Messages = std::vector<std::string>;

Heartbeat heartbeat_in(const Sent& sent) {
  for (MessageDecoder decoder(sent.octets); decoder.next();)
    if (const auto* const found = std::get_if<Heartbeat>(&decoder.submessage())) return *found;
  return {};
}
std::vector<AckNack> acks_of(const World& world, std::size_t participant) {
  std::vector<AckNack> all;
  for (const Sent& sent : world.log)
    if (sent.from == participant)
      for (MessageDecoder decoder(sent.octets); decoder.next();)
        if (const auto* const found = std::get_if<AckNack>(&decoder.submessage())) all.push_back(*found);
  return all;
}

struct Settled : Pair {
  template <class... Config>
  explicit Settled(const Config&... config) : Pair(config...) {
    world.run_until(start + 20_s);
    world.log.clear();
  }
};

// Section "Worked example" of the protocol's sizes: 192 octets of RTPS for 100 octets of CDR with a piggybacked
// HEARTBEAT, 160 without, 64 for the answer.
TEST(Messages, HaveTheSizesOfTheStandard) {
  TimingProfile timing = timing::fast_dds;
  timing.piggyback_interval = 0_ms;
  Settled reliable(writer_config(), reader_config(), timing);
  reliable.write(1, 104);
  reliable.world.run_for(1_s);
  ASSERT_EQ(reliable.world.log.size(), 2u);
  EXPECT_EQ(reliable.world.log[0].kinds(), "INFO_TS DATA HEARTBEAT");
  EXPECT_EQ(reliable.world.log[0].octets.size(), 192u);
  EXPECT_EQ(reliable.world.log[1].kinds(), "INFO_DST ACKNACK");
  EXPECT_EQ(reliable.world.log[1].octets.size(), 64u);
  EXPECT_EQ(reliable.world.log[1].at - reliable.world.log[0].at, 100_us + 5_ms);

  Settled best_effort(writer_config(ReliabilityKind::best_effort), reader_config(ReliabilityKind::best_effort), timing);
  best_effort.write(1, 104);
  EXPECT_EQ(best_effort.world.log.at(0).octets.size(), 160u);
}

TEST(Messages, FitIntoOneEthernetFrame) {
  Settled pair;
  pair.write(1, 20'000);
  pair.world.run_for(100_ms);
  EXPECT_EQ(pair.world.log.size(), 15u);  // 20000 in fragments of 1356
  for (const Sent& sent : pair.world.log) EXPECT_LE(sent.octets.size(), 1472u);
  EXPECT_EQ(pair.take(), (std::vector<std::uint32_t>{1}));
}

TEST(Messages, OfOneSampleToReadersAtSeveralHostsGoToEachOrToTheGroup) {
  for (const bool multicast : {false, true}) {
    World world;
    ParticipantConfig config = World::config(1);
    Participant& writing = world.add(config);
    const WriterHandle writer = *writing.create_writer(writer_config(), world.now).handle;
    for (std::uint8_t i = 2; i <= 4; ++i) {
      config = World::config(i);
      if (multicast) config.multicast_group = 0xEFFF0002;
      Participant& reading = world.add(config);
      for (int n = 0; n < 2; ++n)
        world.match(writing, writer, reading, *reading.create_reader(reader_config(), world.now).handle);
    }
    world.run_until(start + 20_s);
    world.log.clear();
    writing.write(writer, no_key, payload_of(1), world.now);
    world.collect();
    ASSERT_EQ(world.log.size(), 1u);
    EXPECT_EQ(world.log[0].destinations.size(), multicast ? 1u : 3u);  // two readers of a participant share a copy
    world.run_for(100_ms);
    for (std::size_t i = 1; i < 4; ++i)
      for (const std::uint32_t number : {1u, 2u})
        EXPECT_EQ(drain_values(*world.participants[i], ReaderHandle{number}, world.now),
                  (std::vector<std::uint32_t>{1}));
  }
}

TEST(Heartbeats, ComeUntilAllIsAcknowledged) {
  Settled pair;
  pair.world.medium = [&](const Sent& sent) {
    return sent.from == 1 ? std::vector<sim::Duration>() : std::vector{100_us};
  };
  pair.write(1);
  const sim::LocalTime written = pair.world.now;
  pair.world.run_for(10_s);
  EXPECT_EQ(pair.sent(), (Messages{"INFO_TS DATA", "INFO_DST HEARTBEAT", "INFO_DST HEARTBEAT", "INFO_DST HEARTBEAT"}));
  EXPECT_EQ(pair.world.log[1].at, written + 3_s);
  EXPECT_FALSE(heartbeat_in(pair.world.log[1]).is_final);
  pair.world.medium = World().medium;
  pair.world.run_for(100_s);
  EXPECT_EQ(pair.sent(), (Messages{"INFO_DST HEARTBEAT"}));
  EXPECT_TRUE(pair.writing->writer(pair.writer).rtps.is_acknowledged());
}

TEST(Heartbeats, ThatAreCopiesAreNotAnswered) {
  Settled pair;
  pair.world.medium = [&](const Sent& sent) {
    return sent.from == 0 ? std::vector{100_us, 50_ms, 90_ms} : std::vector{100_us};
  };
  pair.write(1);
  pair.world.run_for(20_s);
  EXPECT_EQ(acks_of(pair.world, 1).size(), 1u);
  EXPECT_EQ(pair.take(), (std::vector<std::uint32_t>{1}));
  EXPECT_EQ(pair.reading->reader(pair.reader).rtps.duplicates(), 2u);
}

TEST(Heartbeats, AreSuppressedWhereTheProfileSaysSo) {
  TimingProfile timing = timing::fast_dds;
  timing.piggyback_interval = 0_ms;
  timing.heartbeat_suppression = 10_ms;
  timing.heartbeat_response_delay = 0_ms;
  Settled pair(writer_config(), reader_config(), timing);
  for (std::uint32_t i = 1; i <= 4; ++i) {
    pair.write(i);
    pair.world.run_for(4_ms);
  }
  EXPECT_EQ(acks_of(pair.world, 1).size(), 2u);  // of the first and, 12 ms later, of the fourth
}

TEST(Acknacks, ThatAreCopiesBringNothingAgain) {
  Settled pair;
  bool lose = true;
  pair.world.medium = [&](const Sent& sent) {
    if (sent.from == 0 && std::exchange(lose, false)) return std::vector<sim::Duration>();
    return sent.from == 1 ? std::vector{100_us, 20_ms, 40_ms} : std::vector{100_us};
  };
  pair.write(1);
  pair.world.run_for(20_s);
  EXPECT_EQ(pair.writing->figures().resent, 1u);
  EXPECT_EQ(pair.take(), (std::vector<std::uint32_t>{1}));
}

TEST(Acknacks, OfWhatWasNeverWrittenAreNotBelieved) {
  Settled pair;
  StatefulWriter::Settings settings;
  settings.guid = {World::config(9).prefix, EntityId::user(1, EntityKind::writer_no_key)};
  settings.timing = timing::fast_dds;
  settings.history.history.keep_all = true;
  StatefulWriter writer(settings);
  Outbox outbox(settings.guid.prefix, 1472);
  const Guid reader{World::config(8).prefix, EntityId::user(1, EntityKind::reader_no_key)};
  writer.match({reader, {Locator::udp_v4(0x0A000001u, 7411)}, {}, true, false}, start, outbox);
  writer.write(ChangeKind::alive, no_key, payload_of(1), start, outbox);
  AckNack ack{reader.entity, settings.guid.entity, SequenceNumberSet(SequenceNumber{1000}), 1, true};
  writer.receive(reader, ack, start, outbox);
  EXPECT_FALSE(writer.is_acknowledged());
  ack.missing = SequenceNumberSet(SequenceNumber{2});
  ack.count = 2;
  writer.receive(reader, ack, start, outbox);
  EXPECT_TRUE(writer.is_acknowledged());
}

TEST(Fragments, OnlyWhatIsMissingIsAskedForAgain) {
  Settled pair;
  int number = 0;
  pair.world.medium = [&](const Sent& sent) {
    return sent.from == 0 && (++number == 3 || number == 5) ? std::vector<sim::Duration>() : std::vector{100_us};
  };
  pair.write(1, 8000);  // six fragments
  pair.world.run_for(20_s);
  EXPECT_EQ(pair.sent(), (Messages{"INFO_TS DATA_FRAG", "INFO_TS DATA_FRAG", "INFO_TS DATA_FRAG", "INFO_TS DATA_FRAG",
                                   "INFO_TS DATA_FRAG", "INFO_TS DATA_FRAG", "INFO_DST HEARTBEAT",
                                   "INFO_DST INFO_TS DATA_FRAG", "INFO_DST INFO_TS DATA_FRAG", "INFO_DST HEARTBEAT"}));
  EXPECT_EQ(pair.sent_by(1), (Messages{"INFO_DST ACKNACK NACK_FRAG", "INFO_DST ACKNACK"}));
  EXPECT_EQ(pair.take(), (std::vector<std::uint32_t>{1}));
}

TEST(Fragments, OfHugeSamplesAreRefused) {
  ParticipantConfig config = World::config(1);
  config.receive_limits.max_sample_octets = 5000;
  Settled pair(writer_config(), reader_config(), config);
  pair.write(1, 5004);
  pair.world.run_for(10_s);
  EXPECT_EQ(pair.take(), std::vector<std::uint32_t>());
}

TEST(Matching, OfAnotherReliabilityIsRefusedWithThePolicy) {
  Pair pair(writer_config(ReliabilityKind::best_effort), reader_config());
  ASSERT_EQ(pair.world.count(EventKind::incompatible_qos, 0), 1u);
  ASSERT_EQ(pair.world.count(EventKind::incompatible_qos, 1), 1u);
  EXPECT_EQ(pair.world.events[0].second.policy, PolicyId::reliability);
  EXPECT_EQ(pair.writing->writer(pair.writer).matched.current_count, 0u);
}

TEST(Matching, EndsWithUnmatch) {
  Settled pair;
  pair.write(1);
  pair.world.run_for(100_ms);
  pair.reading->unmatch(pair.reader, pair.writing->data_of(pair.writer).endpoint.guid, pair.world.now);
  pair.writing->unmatch(pair.writer, pair.reading->data_of(pair.reader).endpoint.guid, pair.world.now);
  pair.write(2);
  pair.world.run_for(10_s);
  EXPECT_EQ(pair.take(), (std::vector<std::uint32_t>{1}));
  EXPECT_EQ(pair.world.count(EventKind::unmatched, 0), 1u);
}

}  // namespace
}  // namespace takt::dds
