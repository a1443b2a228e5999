// SPDX-License-Identifier: Apache-2.0
// The reliable built-in endpoints: publications, subscriptions, participant messages (DDSI-RTPS 8.5.4, 8.4.13).
#pragma once

#include <functional>

#include "dds/discovery/data.hpp"
#include "dds/discovery/figures.hpp"
#include "dds/rtps/stateful_reader.hpp"
#include "dds/rtps/stateful_writer.hpp"

namespace takt::dds {

/// One writer and the reader that it talks to at the other participants: reliable, TRANSIENT_LOCAL, KEEP_LAST 1
/// (8.5.4.3).
struct BuiltinTopic {
  EntityId writer;
  EntityId reader;
  std::uint32_t announcer = 0;  ///< bit of the BuiltinEndpointSet that says "has this writer"
  std::uint32_t detector = 0;   ///< the same of the reader
};

namespace builtin_topic {
/// Of servers and clients: SPDP data that is forwarded.
inline constexpr BuiltinTopic participants{entity_id::spdp_writer, entity_id::spdp_reader,
                                           builtin_endpoint::participant_announcer,
                                           builtin_endpoint::participant_detector};
inline constexpr BuiltinTopic publications{entity_id::sedp_publications_writer, entity_id::sedp_publications_reader,
                                           builtin_endpoint::publications_announcer,
                                           builtin_endpoint::publications_detector};
inline constexpr BuiltinTopic subscriptions{entity_id::sedp_subscriptions_writer, entity_id::sedp_subscriptions_reader,
                                            builtin_endpoint::subscriptions_announcer,
                                            builtin_endpoint::subscriptions_detector};
inline constexpr BuiltinTopic messages{entity_id::participant_message_writer, entity_id::participant_message_reader,
                                       builtin_endpoint::participant_message_writer,
                                       builtin_endpoint::participant_message_reader};
}  // namespace builtin_topic

struct BuiltinSettings {
  GuidPrefix prefix;
  TimingProfile timing;
  std::size_t max_message = 1472;
  Epoch epoch;
};

/// The writer of a built-in topic; a change's instance is the GUID of what it tells about.
StatefulWriter make_builtin_writer(const BuiltinTopic& topic, const BuiltinSettings& settings);
StatefulReader make_builtin_reader(const BuiltinTopic& topic, const BuiltinSettings& settings);

/// What a call puts into the outbox.
template <class Call>
MessageCount count_sent(Outbox& outbox, Call call) {
  outbox.end();  // what was begun before does not count
  const Figures before = outbox.figures();
  call();
  outbox.end();
  const Figures& after = outbox.figures();
  return {after.datagrams_sent - before.datagrams_sent, after.datagram_octets_sent - before.datagram_octets_sent};
}

/// What a participant has for a built-in topic.
struct BuiltinUse {
  BuiltinTopic topic;
  bool writes = true;
  bool reads = true;
};

/// The entity id of the writer that a submessage is from, or, if it comes from a reader, is for.
std::optional<EntityId> writer_of(const Submessage& submessage);
/// Where built-in endpoints of a participant are reached.
MatchedReader builtin_reader_of(const ParticipantData& participant, const BuiltinTopic& topic);
/// Those that can be used: UDP over IPv4.
std::vector<Locator> usable(const std::vector<Locator>& locators);

/// The endpoints of one participant for a list of built-in topics.
class BuiltinEndpoints {
 public:
  BuiltinEndpoints(const BuiltinSettings& settings, const std::vector<BuiltinUse>& uses);

  /// Matches with those that the participant has, of the endpoints in the mask. Nothing happens where they are matched
  /// already.
  void connect(const ParticipantData& participant, std::uint32_t mask, sim::LocalTime now, Outbox& outbox);
  void disconnect(const GuidPrefix& participant, sim::LocalTime now);

  /// Tells all that are connected, and all that will be.
  void tell(const BuiltinTopic& topic, const Guid& about, Octets payload, sim::LocalTime now, Outbox& outbox);
  void dispose(const BuiltinTopic& topic, const Guid& about, sim::LocalTime now, Outbox& outbox);

  /// Whether it is for one of these endpoints; then it was taken.
  bool receive(const GuidPrefix& from, const std::optional<Time>& source, const Submessage& submessage,
               sim::LocalTime now, Outbox& outbox);

  struct News {
    EntityId writer;
    Guid about;
    GuidPrefix from;
    bool is_gone = false;
    std::vector<std::byte> payload;
  };
  /// What readers got since the last call.
  std::vector<News> read_news(sim::LocalTime now, Outbox& outbox);

  sim::LocalTime next_wake() const;
  void wake(sim::LocalTime now, Outbox& outbox);
  /// Whether all that was told has been acknowledged by all that are connected.
  bool is_acknowledged() const;

  /// Sent so far, by the writer's id of the topic.
  MessageCount sent(EntityId writer) const;

 private:
  struct Pair {
    BuiltinUse use;
    StatefulWriter writer;
    StatefulReader reader;
    MessageCount sent;
  };
  /// Calls and counts what was sent by it.
  template <class Call>
  void counted(Pair& pair, Outbox& outbox, Call call);
  Pair& pair_of(const BuiltinTopic& topic);

  std::vector<Pair> pairs_;
};

}  // namespace takt::dds
