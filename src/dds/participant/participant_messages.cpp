#include "dds/participant/participant_messages.hpp"

#include <algorithm>
#include <array>

namespace takt::dds {
namespace {

StatefulWriter::Settings writer_settings(const GuidPrefix& prefix, const TimingProfile& timing, std::size_t max_message, Epoch epoch) {
  StatefulWriter::Settings settings;
  settings.guid = {prefix, entity_id::participant_message_writer};
  settings.has_key = true;
  settings.history.keeps_released = true;
  settings.timing = timing;
  settings.max_message = max_message;
  settings.epoch = epoch;
  return settings;
}

/// The key of a message: who, and which kind (8.4.13.5).
InstanceKey key_of(const ParticipantMessageData& data) {
  InstanceKey key{};
  std::copy(data.prefix.octets.begin(), data.prefix.octets.end(), key.begin());
  key[15] = static_cast<std::uint8_t>(data.kind);
  return key;
}

StatefulReader::Settings reader_settings(const GuidPrefix& prefix, const TimingProfile& timing, Epoch epoch) {
  StatefulReader::Settings settings;
  settings.guid = {prefix, entity_id::participant_message_reader};
  settings.reliable = true;
  settings.has_key = true;
  settings.timing = timing;
  settings.epoch = epoch;
  settings.key_of = [](PayloadKind, Octets payload) {
    ParticipantMessageData data;
    return decode(payload, data) == DataVerdict::ok ? key_of(data) : no_key;
  };
  return settings;
}

}  // namespace

ParticipantMessages::ParticipantMessages(const GuidPrefix& prefix, const TimingProfile& timing, std::size_t max_message, Epoch epoch)
    : prefix_(prefix), percent_(timing.liveliness_percent), writer_(writer_settings(prefix, timing, max_message, epoch)), reader_(reader_settings(prefix, timing, epoch)) {}

void ParticipantMessages::add_peer(const GuidPrefix& peer, const std::vector<Locator>& metatraffic, sim::LocalTime now, Outbox& outbox) {
  const Guid their_reader{peer, entity_id::participant_message_reader};
  const Guid their_writer{peer, entity_id::participant_message_writer};
  if (reader_.is_matched(their_writer)) return;
  reader_.match({their_writer, metatraffic, true, true, {}, 0, infinite, {}}, now);
  writer_.match({their_reader, metatraffic, {}, true, true}, now, outbox);
}

void ParticipantMessages::remove_peer(const GuidPrefix& peer, sim::LocalTime now) {
  reader_.unmatch({peer, entity_id::participant_message_writer}, now);
  writer_.unmatch({peer, entity_id::participant_message_reader}, now);
}

void ParticipantMessages::set_lease(LivelinessKind kind, sim::Duration lease, sim::LocalTime now) {
  if (kind != LivelinessKind::automatic || lease == infinite) return;
  const sim::Duration period = lease / 100 * percent_;
  if (period >= period_) return;
  period_ = period;
  send_at_ = std::min(send_at_, now);
}

void ParticipantMessages::send(ParticipantMessageData::Kind kind, sim::LocalTime now, Outbox& outbox) {
  const ParticipantMessageData data{prefix_, kind, {}};
  std::array<std::byte, 64> room{};
  writer_.write(ChangeKind::alive, key_of(data), encode(room, data), now, outbox);
}

sim::LocalTime ParticipantMessages::next_wake() const { return std::min({writer_.next_wake(), reader_.next_wake(), send_at_}); }

void ParticipantMessages::wake(sim::LocalTime now, Outbox& outbox) {
  writer_.wake(now, outbox);
  reader_.wake(now, outbox);
  if (send_at_ > now) return;
  send_at_ = now + period_;
  send(ParticipantMessageData::Kind::automatic, now, outbox);
}

std::optional<ParticipantMessageData> ParticipantMessages::take(sim::LocalTime now, Outbox& outbox) {
  while (const std::optional<Sample> sample = reader_.take(now, outbox)) {
    ParticipantMessageData data;
    if (sample->info.valid_data && decode(sample->payload, data) == DataVerdict::ok) return data;
  }
  return std::nullopt;
}

}  // namespace takt::dds
