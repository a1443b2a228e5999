// SPDX-License-Identifier: Apache-2.0
// Who is matched with whom, by discovery or by hand.
#include "dds/participant/participant.hpp"

namespace takt::dds {

void Participant::report_mismatch(const Matching& matching, std::uint32_t entity, const Guid& remote,
                                  std::uint64_t count, sim::LocalTime now) {
  const bool is_type = matching.relation == Relation::other_type;
  events_.push_back({is_type ? EventKind::inconsistent_topic : EventKind::incompatible_qos,
                     now,
                     entity,
                     remote,
                     {},
                     count,
                     matching.mismatches.empty() ? PolicyId{} : matching.mismatches.front().policy,
                     matching.reason});
}

namespace {

MatchedReader matched_reader(const SubscriptionData& data) {
  MatchedReader reader;
  reader.guid = data.endpoint.guid;
  reader.unicast = data.endpoint.unicast;
  reader.multicast = data.endpoint.multicast;
  reader.reliable = data.qos.reliability.kind == ReliabilityKind::reliable;
  reader.wants_history = data.qos.durability.kind != DurabilityKind::volatile_;
  return reader;
}

MatchedWriter matched_writer(const PublicationData& data) {
  MatchedWriter writer;
  writer.guid = data.endpoint.guid;
  writer.unicast = data.endpoint.unicast;
  writer.reliable = data.qos.reliability.kind == ReliabilityKind::reliable;
  writer.has_history = data.qos.durability.kind != DurabilityKind::volatile_;
  writer.persistence_guid = data.endpoint.persistence_guid;
  writer.ownership_strength = data.qos.ownership_strength.value;
  writer.lifespan = data.qos.lifespan.duration;
  writer.liveliness = data.qos.liveliness;
  return writer;
}

}  // namespace

/// A reader that is matched already and still fits stays as it is.
Matching Participant::try_match(LocalWriter& writer, const SubscriptionData& remote, const MatchedReader& reader,
                                sim::LocalTime now) {
  const Guid& guid = remote.endpoint.guid;
  // Readers of less durability get all from the writers themselves.
  if (writer.config.brings_others && remote.qos.durability.kind < DurabilityKind::transient) return {};
  Matching matching = dds::match(writer.data, remote);
  if (!matching.is_match()) {
    end_match(writer, guid, now);
    if (matching.relation == Relation::incompatible) ++writer.incompatible.total_count;
    if (matching.relation != Relation::other_topic)
      report_mismatch(matching, writer.handle.number, guid, writer.incompatible.total_count, now);
  } else if (!writer.rtps.is_matched(guid)) {
    writer.rtps.match(reader, now, outbox_);
    ++writer.matched.current_count;
    tell(EventKind::matched, writer.handle.number, guid, ++writer.matched.total_count, now);
  }
  return matching;
}

Matching Participant::try_match(LocalReader& reader, const PublicationData& remote, const MatchedWriter& writer,
                                sim::LocalTime now) {
  const Guid& guid = remote.endpoint.guid;
  Matching matching = dds::match(remote, reader.data);
  if (!matching.is_match()) {
    end_match(reader, guid, now);
    if (matching.relation == Relation::incompatible) ++reader.incompatible.total_count;
    if (matching.relation != Relation::other_topic)
      report_mismatch(matching, reader.handle.number, guid, reader.incompatible.total_count, now);
  } else if (!reader.rtps.is_matched(guid)) {
    reader.rtps.match(writer, now);
    ++reader.matched.current_count;
    tell(EventKind::matched, reader.handle.number, guid, ++reader.matched.total_count, now);
  }
  return matching;
}

void Participant::end_match(LocalWriter& writer, const Guid& remote, sim::LocalTime now) {
  if (!writer.rtps.is_matched(remote)) return;
  writer.rtps.unmatch(remote, now);
  tell(EventKind::unmatched, writer.handle.number, remote, --writer.matched.current_count, now);
}

void Participant::end_match(LocalReader& reader, const Guid& remote, sim::LocalTime now) {
  if (!reader.rtps.is_matched(remote)) return;
  reader.rtps.unmatch(remote, now);
  tell(EventKind::unmatched, reader.handle.number, remote, --reader.matched.current_count, now);
}

Matching Participant::match(WriterHandle writer, const SubscriptionData& remote, sim::LocalTime now) {
  Matching matching = try_match(local(writer), remote, matched_reader(remote), now);
  settle(now);
  return matching;
}

Matching Participant::match(ReaderHandle reader, const PublicationData& remote, sim::LocalTime now) {
  Matching matching = try_match(local(reader), remote, matched_writer(remote), now);
  settle(now);
  return matching;
}

void Participant::unmatch(WriterHandle writer, const Guid& remote, sim::LocalTime now) {
  end_match(local(writer), remote, now);
  settle(now);
}

void Participant::unmatch(ReaderHandle reader, const Guid& remote, sim::LocalTime now) {
  end_match(local(reader), remote, now);
  settle(now);
}

/// Entities of one's own match, too.
void Participant::match_with_all(LocalWriter& writer, sim::LocalTime now) {
  for (auto& [number, reader] : readers_) {
    try_match(*reader, writer.data, matched_writer(writer.data), now);
    try_match(writer, reader->data, matched_reader(reader->data), now);
  }
  if (!discovery_) return;
  for (const auto& [guid, data] : discovery_->subscriptions())
    try_match(writer, data, discovery_->matched_reader(data), now);
}

void Participant::match_with_all(LocalReader& reader, sim::LocalTime now) {
  for (auto& [number, writer] : writers_) {
    try_match(reader, writer->data, matched_writer(writer->data), now);
    try_match(*writer, reader.data, matched_reader(reader.data), now);
  }
  if (!discovery_) return;
  for (const auto& [guid, data] : discovery_->publications())
    try_match(reader, data, discovery_->matched_writer(data), now);
}

void Participant::accept_discovered(sim::LocalTime now) {
  if (!discovery_) return;
  while (const std::optional<DiscoveryEvent> event = discovery_->next_event()) accept_discovered(*event, now);
}

void Participant::accept_discovered(const DiscoveryEvent& event, sim::LocalTime now) {
  using Kind = DiscoveryEvent::Kind;
  switch (event.kind) {
    case Kind::participant_found:
      return tell(EventKind::participant_discovered, 0, event.subject, 0, now);
    case Kind::participant_lost:
      return tell(EventKind::participant_lost, 0, event.subject, 0, now);
    case Kind::publication_found:
    case Kind::publication_lost: {
      // It may be lost by now, though this event tells that it was found.
      const auto at = discovery_->publications().find(event.subject);
      for (auto& [number, reader] : readers_)
        at == discovery_->publications().end()
            ? end_match(*reader, event.subject, now)
            : void(try_match(*reader, at->second, discovery_->matched_writer(at->second), now));
      return;
    }
    case Kind::subscription_found:
    case Kind::subscription_lost: {
      const auto at = discovery_->subscriptions().find(event.subject);
      for (auto& [number, writer] : writers_)
        at == discovery_->subscriptions().end()
            ? end_match(*writer, event.subject, now)
            : void(try_match(*writer, at->second, discovery_->matched_reader(at->second), now));
      return;
    }
    case Kind::liveliness_asserted:
      return assert_writers_of(event.subject.prefix,
                               event.liveliness == ParticipantMessageData::Kind::manual
                                   ? LivelinessKind::manual_by_participant
                                   : LivelinessKind::automatic,
                               now);
  }
}

/// Writers whose liveliness is their participant's live as long as its messages come.
void Participant::assert_writers_of(const GuidPrefix& participant, LivelinessKind kind, sim::LocalTime now) {
  for (auto& [number, reader] : readers_) {
    std::vector<Guid> alive;
    for (const auto& [guid, proxy] : reader->rtps.writers())
      if (guid.prefix == participant && proxy.writer.liveliness.kind == kind) alive.push_back(guid);
    for (const Guid& guid : alive) reader->rtps.assert_alive(guid, now);
  }
}

}  // namespace takt::dds
