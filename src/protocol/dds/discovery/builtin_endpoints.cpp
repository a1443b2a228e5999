// SPDX-License-Identifier: Apache-2.0
#include "dds/discovery/builtin_endpoints.hpp"

#include <algorithm>

namespace takt::dds {
namespace {

InstanceKey key_of_payload(const BuiltinTopic& topic, Octets payload) {
  Guid about;
  ParticipantMessageData message;
  if (topic.writer == entity_id::participant_message_writer) {
    if (decode(payload, message) == DataVerdict::ok)
      about = {message.prefix, {static_cast<std::uint32_t>(message.kind)}};
  } else {
    decode_key(payload, about);
  }
  return key_hash_of(about);
}

MatchedWriter builtin_writer_of(const ParticipantData& participant, const BuiltinTopic& topic) {
  MatchedWriter writer;
  writer.guid = {participant.guid.prefix, topic.writer};
  writer.unicast = builtin_reader_of(participant, topic).unicast;
  writer.reliable = true;
  writer.has_history = true;
  return writer;
}

}  // namespace

std::optional<EntityId> writer_of(const Submessage& submessage) {
  return std::visit(
      [](const auto& each) -> std::optional<EntityId> {
        if constexpr (requires { each.writer; })
          return each.writer;
        else
          return std::nullopt;
      },
      submessage);
}

std::vector<Locator> usable(const std::vector<Locator>& locators) {
  std::vector<Locator> list;
  std::copy_if(locators.begin(), locators.end(), std::back_inserter(list),
               [](const Locator& locator) { return locator.is_udp_v4(); });
  return list;
}

MatchedReader builtin_reader_of(const ParticipantData& participant, const BuiltinTopic& topic) {
  MatchedReader reader;
  reader.guid = {participant.guid.prefix, topic.reader};
  reader.unicast = usable(participant.metatraffic_unicast);
  if (reader.unicast.empty()) reader.unicast = usable(participant.metatraffic_multicast);
  reader.reliable = true;
  reader.wants_history = true;
  return reader;
}

StatefulWriter make_builtin_writer(const BuiltinTopic& topic, const BuiltinSettings& settings) {
  StatefulWriter::Settings made;
  made.guid = {settings.prefix, topic.writer};
  made.has_key = false;  // the payload tells the key, so no hash of it is sent
  made.history.keeps_released = true;
  made.timing = settings.timing;
  made.max_message = settings.max_message;
  made.epoch = settings.epoch;
  return StatefulWriter(made);
}

StatefulReader make_builtin_reader(const BuiltinTopic& topic, const BuiltinSettings& settings) {
  StatefulReader::Settings made;
  made.guid = {settings.prefix, topic.reader};
  made.reliable = true;
  made.has_key = true;
  made.timing = settings.timing;
  // A participant that was lost on one side only is found again by this.
  if (made.timing.initial_acknack_delay == TimingProfile::off)
    made.timing.initial_acknack_delay = made.timing.heartbeat_response_delay;
  made.epoch = settings.epoch;
  made.key_of = [topic](PayloadKind, Octets payload) { return key_of_payload(topic, payload); };
  return StatefulReader(std::move(made));
}

BuiltinEndpoints::BuiltinEndpoints(const BuiltinSettings& settings, const std::vector<BuiltinUse>& uses) {
  for (const BuiltinUse& use : uses)
    pairs_.push_back({use, make_builtin_writer(use.topic, settings), make_builtin_reader(use.topic, settings), {}});
}

template <class Call>
void BuiltinEndpoints::counted(Pair& pair, Outbox& outbox, Call call) {
  pair.sent += count_sent(outbox, call);
}

void BuiltinEndpoints::connect(const ParticipantData& participant, std::uint32_t mask, sim::LocalTime now,
                               Outbox& outbox) {
  const std::uint32_t theirs = participant.builtin_endpoints & mask;
  for (Pair& pair : pairs_) {
    const BuiltinTopic& topic = pair.use.topic;
    const MatchedWriter writer = builtin_writer_of(participant, topic);
    const MatchedReader reader = builtin_reader_of(participant, topic);
    counted(pair, outbox, [&] {
      if (pair.use.reads && (theirs & topic.announcer) != 0 && !pair.reader.is_matched(writer.guid))
        pair.reader.match(writer, now);
      if (pair.use.writes && (theirs & topic.detector) != 0 && !pair.writer.is_matched(reader.guid))
        pair.writer.match(reader, now, outbox);
    });
  }
}

void BuiltinEndpoints::disconnect(const GuidPrefix& participant, sim::LocalTime now) {
  for (Pair& pair : pairs_) {
    pair.writer.unmatch({participant, pair.use.topic.reader}, now);
    pair.reader.unmatch({participant, pair.use.topic.writer}, now);
  }
}

BuiltinEndpoints::Pair& BuiltinEndpoints::pair_of(const BuiltinTopic& topic) {
  const auto found = std::find_if(pairs_.begin(), pairs_.end(),
                                  [&](const Pair& pair) { return pair.use.topic.writer == topic.writer; });
  TAKT_CHECK(found != pairs_.end() && found->use.writes, "there is such a built-in writer");
  return *found;
}

void BuiltinEndpoints::tell(const BuiltinTopic& topic, const Guid& about, Octets payload, sim::LocalTime now,
                            Outbox& outbox) {
  Pair& pair = pair_of(topic);
  counted(pair, outbox, [&] { pair.writer.write(ChangeKind::alive, key_hash_of(about), payload, now, outbox); });
}

void BuiltinEndpoints::dispose(const BuiltinTopic& topic, const Guid& about, sim::LocalTime now, Outbox& outbox) {
  Pair& pair = pair_of(topic);
  std::array<std::byte, 64> buffer;
  const Octets key = encode_key(buffer, about);
  counted(pair, outbox,
          [&] { pair.writer.write(ChangeKind::disposed_unregistered, key_hash_of(about), key, now, outbox); });
}

bool BuiltinEndpoints::receive(const GuidPrefix& from, const std::optional<Time>& source, const Submessage& submessage,
                               sim::LocalTime now, Outbox& outbox) {
  const std::optional<EntityId> writer_id = writer_of(submessage);
  const auto found =
      std::find_if(pairs_.begin(), pairs_.end(), [&](const Pair& pair) { return writer_id == pair.use.topic.writer; });
  if (found == pairs_.end()) return false;
  Pair& pair = *found;
  const Guid writer{from, pair.use.topic.writer};
  counted(pair, outbox, [&] {
    std::visit(
        [&](const auto& each) {
          using Kind = std::decay_t<decltype(each)>;
          if constexpr (std::is_same_v<Kind, AckNack> || std::is_same_v<Kind, NackFrag>) {
            pair.writer.receive(Guid{from, each.reader}, each, now, outbox);
          } else if constexpr (std::is_same_v<Kind, Data> || std::is_same_v<Kind, DataFrag>) {
            pair.reader.receive(writer, each, source, now, outbox);
          } else if constexpr (std::is_same_v<Kind, Heartbeat> || std::is_same_v<Kind, HeartbeatFrag> ||
                               std::is_same_v<Kind, Gap>) {
            pair.reader.receive(writer, each, now, outbox);
          }
        },
        submessage);
  });
  return true;
}

std::vector<BuiltinEndpoints::News> BuiltinEndpoints::read_news(sim::LocalTime now, Outbox& outbox) {
  std::vector<News> list;
  for (Pair& pair : pairs_) {
    counted(pair, outbox, [&] {
      while (std::optional<Sample> sample = pair.reader.take(now, outbox)) {
        News news{
            pair.use.topic.writer, guid_of(sample->info.key), sample->info.writer.prefix, !sample->info.valid_data, {}};
        news.payload = std::move(sample->payload);
        list.push_back(std::move(news));
      }
    });
  }
  return list;
}

sim::LocalTime BuiltinEndpoints::next_wake() const {
  sim::LocalTime next = sim::LocalTime::never();
  for (const Pair& pair : pairs_) next = std::min({next, pair.writer.next_wake(), pair.reader.next_wake()});
  return next;
}

void BuiltinEndpoints::wake(sim::LocalTime now, Outbox& outbox) {
  for (Pair& pair : pairs_) {
    counted(pair, outbox, [&] {
      if (pair.writer.next_wake() <= now) pair.writer.wake(now, outbox);
      if (pair.reader.next_wake() <= now) pair.reader.wake(now, outbox);
    });
  }
}

bool BuiltinEndpoints::is_acknowledged() const {
  return std::all_of(pairs_.begin(), pairs_.end(), [](const Pair& pair) { return pair.writer.is_acknowledged(); });
}

MessageCount BuiltinEndpoints::sent(EntityId writer) const {
  const auto found =
      std::find_if(pairs_.begin(), pairs_.end(), [&](const Pair& pair) { return pair.use.topic.writer == writer; });
  return found == pairs_.end() ? MessageCount{} : found->sent;
}

}  // namespace takt::dds
