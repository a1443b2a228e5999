// Who is matched with whom, by discovery or by hand.
#include "dds/participant/participant.hpp"

namespace takt::dds {

void Participant::tell_mismatch(const Matching& matching, std::uint32_t entity, const Guid& remote, std::uint64_t count, sim::LocalTime now) {
  const bool is_type = matching.relation == Relation::other_type;
  events_.push_back({is_type ? EventKind::inconsistent_topic : EventKind::incompatible_qos, now, entity, remote, {}, count,
                     matching.mismatches.empty() ? PolicyId{} : matching.mismatches.front().policy, matching.reason});
}

Matching Participant::match(WriterHandle handle, const SubscriptionData& remote, sim::LocalTime now) {
  LocalWriter& writer = local(handle);
  const Guid& guid = remote.endpoint.guid;
  Matching matching = dds::match(writer.data, remote);
  if (!matching.is_match()) {
    unmatch(handle, guid, now);
    if (matching.relation == Relation::incompatible) ++writer.incompatible.total_count;
    if (matching.relation != Relation::other_topic) tell_mismatch(matching, handle.number, guid, writer.incompatible.total_count, now);
    return matching;
  }
  if (writer.rtps.is_matched(guid)) return matching;  // other QoS that still fits changes nothing for the writer
  MatchedReader reader;
  reader.guid = guid;
  reader.unicast = remote.endpoint.unicast;
  reader.multicast = remote.endpoint.multicast;
  reader.reliable = remote.qos.reliability.kind == ReliabilityKind::reliable;
  reader.wants_history = remote.qos.durability.kind != DurabilityKind::volatile_;
  writer.rtps.match(reader, now, outbox_);
  ++writer.matched.current_count;
  tell(EventKind::matched, handle.number, guid, ++writer.matched.total_count, now);
  settle(now);
  return matching;
}

Matching Participant::match(ReaderHandle handle, const PublicationData& remote, sim::LocalTime now) {
  LocalReader& reader = local(handle);
  const Guid& guid = remote.endpoint.guid;
  Matching matching = dds::match(remote, reader.data);
  if (!matching.is_match()) {
    unmatch(handle, guid, now);
    if (matching.relation == Relation::incompatible) ++reader.incompatible.total_count;
    if (matching.relation != Relation::other_topic) tell_mismatch(matching, handle.number, guid, reader.incompatible.total_count, now);
    return matching;
  }
  if (reader.rtps.is_matched(guid)) return matching;
  MatchedWriter writer;
  writer.guid = guid;
  writer.unicast = remote.endpoint.unicast;
  writer.reliable = remote.qos.reliability.kind == ReliabilityKind::reliable;
  writer.has_history = remote.qos.durability.kind != DurabilityKind::volatile_;
  writer.persistence_guid = remote.endpoint.persistence_guid;
  writer.ownership_strength = remote.qos.ownership_strength.value;
  writer.lifespan = remote.qos.lifespan.duration;
  writer.liveliness = remote.qos.liveliness;
  reader.rtps.match(writer, now);
  ++reader.matched.current_count;
  tell(EventKind::matched, handle.number, guid, ++reader.matched.total_count, now);
  settle(now);
  return matching;
}

void Participant::unmatch(WriterHandle handle, const Guid& remote, sim::LocalTime now) {
  LocalWriter& writer = local(handle);
  if (!writer.rtps.is_matched(remote)) return;
  writer.rtps.unmatch(remote, now);
  tell(EventKind::unmatched, handle.number, remote, --writer.matched.current_count, now);
  settle(now);
}

void Participant::unmatch(ReaderHandle handle, const Guid& remote, sim::LocalTime now) {
  LocalReader& reader = local(handle);
  if (!reader.rtps.is_matched(remote)) return;
  reader.rtps.unmatch(remote, now);
  tell(EventKind::unmatched, handle.number, remote, --reader.matched.current_count, now);
  settle(now);
}

void Participant::add_peer(const GuidPrefix& peer, const std::vector<Locator>& metatraffic, sim::LocalTime now) { messages_.add_peer(peer, metatraffic, now, outbox_); }

void Participant::remove_peer(const GuidPrefix& peer, sim::LocalTime now) { messages_.remove_peer(peer, now); }

}  // namespace takt::dds
