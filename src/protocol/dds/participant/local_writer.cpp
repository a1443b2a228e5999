// SPDX-License-Identifier: Apache-2.0
#include "dds/participant/local_writer.hpp"

#include <algorithm>

#include "dds/history/expiry.hpp"

namespace takt::dds {
namespace {

StatefulWriter::Settings settings_of(const WriterConfig& config, const ParticipantConfig& participant, const Guid& guid,
                                     std::optional<KeptChanges>& kept) {
  StatefulWriter::Settings settings;
  settings.guid = guid;
  settings.reliable = config.qos.reliability.kind == ReliabilityKind::reliable;
  settings.has_key = config.has_key;
  settings.asynchronous = config.asynchronous;
  settings.brings_others = config.brings_others;
  settings.history.history = HistorySettings::from(config.qos.history, config.qos.resource_limits);
  settings.history.keeps_released = config.qos.durability.kind != DurabilityKind::volatile_;
  settings.history.lifespan = config.qos.lifespan.duration;
  settings.history.deadline = config.qos.deadline.period;
  settings.timing = participant.timing;
  settings.max_message = participant.max_message;
  settings.multicast_to_one = participant.multicast_to_one;
  settings.transport_priority = config.qos.transport_priority.value;
  settings.epoch = participant.epoch;
  for (const FlowControllerSettings& flow : participant.flow_controllers)
    if (config.asynchronous && flow.name == config.flow_controller && flow.max_bytes_per_period != 0)
      settings.max_message =
          std::min<std::size_t>(settings.max_message, flow.max_bytes_per_period);  // otherwise it would never be sent
  if (kept) settings.history.removed = [&kept](SequenceNumber number, bool is_last) { kept->erase(number, is_last); };
  return settings;
}

}  // namespace

LocalWriter::LocalWriter(WriterHandle writer_handle, const WriterConfig& writer_config,
                         const ParticipantConfig& participant, const Guid& guid)
    : handle(writer_handle),
      config(writer_config),
      kept(writer_config.storage != nullptr
               ? std::optional<KeptChanges>(std::in_place, *writer_config.storage, writer_config.persistence_guid,
                                            participant.epoch)
               : std::nullopt),
      rtps(settings_of(writer_config, participant, guid, kept)) {
  data.endpoint.guid = guid;
  data.endpoint.participant = {guid.prefix, entity_id::participant};
  data.endpoint.topic_name = config.topic;
  data.endpoint.type_name = config.type;
  data.endpoint.persistence_guid = config.persistence_guid;
  data.qos = config.qos;
  if (!kept) return;
  const SequenceNumber last = kept->last();
  for (CacheChange& change : kept->changes()) {
    change.expires = expiry_of(change.source, config.qos.lifespan.duration);
    rtps.history().restore(std::move(change));
  }
  rtps.history().go_on_after(last);
}

void LocalWriter::write(CacheChange change, sim::LocalTime now, Outbox& outbox) {
  if (kept) {
    // Kept before it is sent: what a reader has seen is never numbered again.
    change.number = rtps.history().last() + 1;
    kept->put(change);
  }
  rtps.write(std::move(change), now, outbox);
  assert_liveliness(now);
}

void LocalWriter::assert_liveliness(sim::LocalTime now) {
  is_alive = true;
  if (config.qos.liveliness.kind != LivelinessKind::automatic)
    lease_until = now.plus_saturated(config.qos.liveliness.lease_duration);
}

sim::LocalTime LocalWriter::next_wake() const {
  sim::LocalTime next = std::min({rtps.next_wake(), rtps.history().deadlines().next(), lease_until});
  if (wait) next = std::min({next, wait->until, rtps.history().next_expiry()});
  return next;
}

void LocalWriter::wake(sim::LocalTime now, std::deque<Event>& events) {
  const std::uint64_t before = deadline_missed.total_count;
  rtps.history().deadlines().advance(now, [&](const InstanceKey& key) {
    ++deadline_missed.total_count;
    deadline_missed.last_instance = key;
  });
  if (deadline_missed.total_count != before)
    events.push_back({EventKind::deadline_missed,
                      now,
                      handle.number,
                      {},
                      deadline_missed.last_instance,
                      deadline_missed.total_count,
                      {},
                      {}});
  if (lease_until <= now) {
    lease_until = sim::LocalTime::never();
    is_alive = false;
    events.push_back({EventKind::liveliness_lost, now, handle.number, {}, {}, ++liveliness_lost.total_count, {}, {}});
  }
  check_wait(now, events);
}

/// Room that is there at the very end of the time still counts.
void LocalWriter::check_wait(sim::LocalTime now, std::deque<Event>& events) {
  if (!wait) return;
  const bool has_room = !rtps.history().obstacle(wait->key, now);
  if (!has_room && now < wait->until) return;
  events.push_back(
      {has_room ? EventKind::writable : EventKind::write_timed_out, now, handle.number, {}, wait->key, 0, {}, {}});
  wait.reset();
}

}  // namespace takt::dds
