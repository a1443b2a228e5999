// SPDX-License-Identifier: Apache-2.0
#include "dds/persistence/persistence_service.hpp"

#include <algorithm>

#include "sim/check.hpp"

namespace takt::dds {
namespace {

/// The name of a topic's entities in the storage: FNV-1a of its name, so that it does not depend on the order in which
/// topics are added.
std::uint32_t hash_of(const std::string& text) {
  std::uint32_t hash = 2166136261u;
  for (const char letter : text) hash = (hash ^ static_cast<std::uint8_t>(letter)) * 16777619u;
  return hash;
}

}  // namespace

std::vector<std::string> PersistenceService::add(const DurableTopic& topic, sim::LocalTime now) {
  if (places_.contains(topic.topic)) return {"topic: " + topic.topic + " is kept already"};
  if (topic.qos.durability.kind < DurabilityKind::transient)
    return {"durability: a persistence service keeps topics that are TRANSIENT or PERSISTENT"};
  if (topic.qos.ownership.kind == OwnershipKind::exclusive)
    return {"ownership: EXCLUSIVE is not supported by the persistence service"};
  const std::uint32_t hash = hash_of(topic.topic);
  for (const auto& [name, place] : places_)
    if (hash_of(name) >> 8 == hash >> 8)
      return {"topic: " + topic.topic + " has the same hash as " + name + "; another service has to keep it"};
  const bool is_persistent = topic.qos.durability.kind == DurabilityKind::persistent;

  WriterConfig writing;
  writing.topic = topic.topic;
  writing.type = topic.type;
  writing.has_key = topic.has_key;
  writing.qos = topic.qos;
  writing.qos.reliability = {ReliabilityKind::reliable, infinite};
  writing.qos.history = topic.qos.durability_service.history;
  writing.qos.resource_limits = topic.qos.durability_service.resource_limits;
  writing.qos.data_lifecycle.autodispose_unregistered_instances = true;
  writing.brings_others = true;
  writing.persistence_guid = {name_, EntityId::user(hash >> 8, EntityKind::writer_group)};
  if (is_persistent) writing.storage = &storage_;

  ReaderConfig reading;
  reading.topic = topic.topic;
  reading.type = topic.type;
  reading.has_key = topic.has_key;
  reading.qos.reliability.kind = ReliabilityKind::reliable;
  reading.qos.durability.kind =
      DurabilityKind::transient_local;  // from the writers themselves, not from other services
  reading.qos.history.kind = HistoryKind::keep_all;
  reading.qos.partition = topic.qos.partition;
  reading.qos.liveliness.kind = LivelinessKind::automatic;
  reading.persistence_guid = {name_, EntityId::user(hash >> 8, EntityKind::reader_group)};
  if (is_persistent) reading.storage = &storage_;
  reading.commits_by_hand = true;  // kept first: the end of the service in between loses nothing

  const Created<WriterHandle> writer = participant_.create_writer(writing, now);
  if (!writer) return writer.problems;
  const Created<ReaderHandle> reader = participant_.create_reader(reading, now);
  TAKT_CHECK(reader.handle.has_value(), "a service's reader is sound if its writer is");
  // What was kept but not committed when the service ended.
  for (const auto& [number, change] : participant_.writer(*writer.handle).rtps.history().changes())
    if (change.original) participant_.mark_delivered(*reader.handle, *change.original);
  places_[topic.topic] = {
      *reader.handle, *writer.handle, topic.qos.durability_service.service_cleanup_delay, std::nullopt, 0, false, {}};
  return {};
}

void PersistenceService::run(sim::LocalTime now) {
  for (auto& [name, place] : places_) {
    if (place.held && keep(place, *place.held, now)) place.held.reset();
    while (!place.held) {
      std::optional<Sample> sample = participant_.take(place.reader, now);
      if (!sample) break;
      place.received += sample->info.valid_data ? 1 : 0;
      if (!keep(place, *sample, now)) place.held = std::move(sample);
    }
    while (!place.cleanups.empty() && place.cleanups.begin()->first.first <= now) {
      const auto& [when, original] = *place.cleanups.begin();
      const WriteResult result =
          participant_.write_for(place.writer, original, ChangeKind::disposed_unregistered, when.second, {}, now, now);
      place.cleanup_waits = result.verdict == WriteVerdict::would_block;
      if (place.cleanup_waits) break;
      place.cleanups.erase(place.cleanups.begin());
    }
  }
}

/// What ends because a writer left is no end for a service; what is disposed is.
bool PersistenceService::keep(Place& place, const Sample& sample, sim::LocalTime now) {
  const SampleInfo& info = sample.info;
  if (!info.valid_data && info.instance_state != InstanceState::not_alive_disposed) {
    participant_.commit(place.reader, info);
    return true;
  }
  const OriginalWriter original{info.identity, info.number};
  const ChangeKind kind = info.valid_data ? ChangeKind::alive : ChangeKind::disposed;
  const WriteResult result =
      participant_.write_for(place.writer, original, kind, info.key, sample.payload, info.source_timestamp, now);
  if (result.verdict == WriteVerdict::would_block) return false;
  participant_.commit(place.reader, info);
  if (info.valid_data)
    std::erase_if(place.cleanups, [&](const auto& each) { return each.first.second == info.key; });
  else
    place.cleanups[{now.plus_saturated(place.cleanup_delay), info.key}] = original;
  return true;
}

sim::LocalTime PersistenceService::next_wake() const {
  sim::LocalTime next = sim::LocalTime::never();
  for (const auto& [name, place] : places_)
    if (!place.cleanups.empty() && !place.cleanup_waits) next = std::min(next, place.cleanups.begin()->first.first);
  return next;
}

std::uint64_t PersistenceService::received(const std::string& topic) const {
  const auto at = places_.find(topic);
  return at == places_.end() ? 0 : at->second.received;
}

std::optional<WriterHandle> PersistenceService::writer_of(const std::string& topic) const {
  const auto at = places_.find(topic);
  return at == places_.end() ? std::nullopt : std::optional(at->second.writer);
}

std::optional<ReaderHandle> PersistenceService::reader_of(const std::string& topic) const {
  const auto at = places_.find(topic);
  return at == places_.end() ? std::nullopt : std::optional(at->second.reader);
}

std::size_t PersistenceService::kept(const std::string& topic) const {
  const auto at = places_.find(topic);
  return at == places_.end() ? 0 : participant_.writer(at->second.writer).rtps.history().size();
}

}  // namespace takt::dds
