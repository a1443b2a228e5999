// SPDX-License-Identifier: Apache-2.0
#include "dds/participant/local_reader.hpp"

namespace takt::dds {
namespace {

StatefulReader::Settings settings_of(const ReaderConfig& config, const ParticipantConfig& participant,
                                     const Guid& guid) {
  StatefulReader::Settings settings;
  settings.guid = guid;
  settings.reliable = config.qos.reliability.kind == ReliabilityKind::reliable;
  settings.has_key = config.has_key;
  settings.tracks_delivered = config.qos.durability.kind >= DurabilityKind::transient || config.storage != nullptr;
  settings.history.history = HistorySettings::from(config.qos.history, config.qos.resource_limits);
  settings.history.exclusive = config.qos.ownership.kind == OwnershipKind::exclusive;
  settings.history.by_source = config.qos.destination_order.kind == DestinationOrderKind::by_source_timestamp;
  settings.history.passes = config.passes;
  settings.history.minimum_separation = config.qos.time_based_filter.minimum_separation;
  settings.history.deadline = config.qos.deadline.period;
  settings.history.data_lifecycle = config.qos.data_lifecycle;
  settings.timing = participant.timing;
  settings.limits = participant.receive_limits;
  settings.epoch = participant.epoch;
  settings.key_of = config.key_of;
  return settings;
}

}  // namespace

LocalReader::LocalReader(ReaderHandle reader_handle, const ReaderConfig& reader_config,
                         const ParticipantConfig& participant, const Guid& guid)
    : handle(reader_handle),
      config(reader_config),
      kept(reader_config.storage != nullptr
               ? std::optional<KeptNumbers>(std::in_place, *reader_config.storage, reader_config.persistence_guid)
               : std::nullopt),
      rtps(settings_of(reader_config, participant, guid)) {
  data.endpoint.guid = guid;
  data.endpoint.participant = {guid.prefix, entity_id::participant};
  data.endpoint.topic_name = config.topic;
  data.endpoint.type_name = config.type;
  data.endpoint.persistence_guid = config.persistence_guid;
  data.qos = config.qos;
  if (!config.content_filter.empty())
    data.content_filter = {config.topic + "/filtered", config.topic, config.content_filter};
  if (!kept) return;
  taken_ = kept->all();
  for (const auto& [writer, numbers] : taken_) rtps.restore_delivered(writer, numbers);
}

std::optional<Sample> LocalReader::take(sim::LocalTime now, Outbox& outbox) {
  std::optional<Sample> sample = rtps.take(now, outbox);
  if (sample && !config.commits_by_hand) commit(sample->info);
  return sample;
}

void LocalReader::commit(const SampleInfo& info) {
  if (!kept || info.number < first_sequence_number) return;  // without a number: a writer left
  NumberRanges& numbers = taken_[info.identity];
  numbers.insert(info.number);
  kept->put(info.identity, numbers);
}

void LocalReader::report(sim::LocalTime now, std::deque<Event>& events) {
  const auto tell = [&](EventKind kind, std::uint64_t count, std::uint64_t& reported, const InstanceKey& instance) {
    if (count == reported) return;
    reported = count;
    events.push_back({kind, now, handle.number, {}, instance, count, {}, {}});
  };
  const std::uint64_t arrived = rtps.drain_arrival_count();
  if (arrived != 0) events.push_back({EventKind::data_available, now, handle.number, {}, {}, arrived, {}, {}});
  tell(EventKind::sample_rejected, rtps.history().sample_rejected().total_count, rejected_,
       rtps.history().sample_rejected().last_instance);
  tell(EventKind::sample_lost, rtps.sample_lost().total_count, lost_, {});
  tell(EventKind::deadline_missed, rtps.history().deadline_missed().total_count, deadline_missed_,
       rtps.history().deadline_missed().last_instance);
  tell(EventKind::liveliness_changed, rtps.liveliness_changed().changes, liveliness_changes_, {});
}

}  // namespace takt::dds
