// SPDX-License-Identifier: Apache-2.0
// What comes in, submessage by submessage, to those that it concerns.
#include "dds/message/decoder.hpp"
#include "dds/participant/participant.hpp"

namespace takt::dds {
namespace {

template <class Submessage>
constexpr bool has_timestamp = std::is_same_v<Submessage, Data> || std::is_same_v<Submessage, DataFrag>;
template <class Submessage>
constexpr bool is_for_readers = has_timestamp<Submessage> || std::is_same_v<Submessage, Heartbeat> ||
                                std::is_same_v<Submessage, HeartbeatFrag> || std::is_same_v<Submessage, Gap>;
template <class Submessage>
constexpr bool is_for_writer = std::is_same_v<Submessage, AckNack> || std::is_same_v<Submessage, NackFrag>;

template <class Submessage>
void hand(StatefulReader& reader, const Guid& writer, const Submessage& submessage, std::optional<Time> timestamp,
          sim::LocalTime now, Outbox& outbox) {
  if constexpr (has_timestamp<Submessage>)
    reader.receive(writer, submessage, timestamp, now, outbox);
  else
    reader.receive(writer, submessage, now, outbox);
}

}  // namespace

/// A reader that is not matched with the writer takes nothing.
template <class Submessage>
void Participant::to_readers(const Submessage& submessage, const GuidPrefix& source, std::optional<Time> timestamp,
                             sim::LocalTime now) {
  const Guid writer{source, submessage.writer};
  for (auto& [number, reader] : readers_)
    if (submessage.reader.is_unknown() || submessage.reader == reader->rtps.guid().entity)
      hand(reader->rtps, writer, submessage, timestamp, now, outbox_);
}

template <class Submessage>
void Participant::to_writer(const Submessage& submessage, const GuidPrefix& source, sim::LocalTime now) {
  const Guid reader{source, submessage.reader};
  const auto writer = writers_by_id_.find(submessage.writer);
  if (writer != writers_by_id_.end()) writer->second->rtps.receive(reader, submessage, now, outbox_);
}

void Participant::receive(Octets message, const Locator&, sim::LocalTime now) {
  // What was sent to a group comes back; one's own readers have had it.
  const MessageDecoder head(message);
  if (head.verdict() == MessageStatus::ok && head.header().prefix == config_.prefix) return;
  Figures& figures = outbox_.figures();
  ++figures.messages_received;
  figures.octets_received += message.size();
  dispatch(message, now);
  settle(now);
}

void Participant::dispatch(Octets message, sim::LocalTime now) {
  Figures& figures = outbox_.figures();
  MessageDecoder decoder(message);
  while (decoder.next()) {
    figures.received.count(decoder.kind());
    const Interpretation& how = decoder.interpretation();
    if (!how.destination.is_unknown() && how.destination != config_.prefix) continue;
    if (discovery_) {
      discovery_->heard(how.source, now);
      if (discovery_->receive(how, decoder.submessage(), now, outbox_)) continue;
    }
    std::visit(
        [&](const auto& submessage) {
          using Kind = std::decay_t<decltype(submessage)>;
          if constexpr (is_for_readers<Kind>)
            to_readers(submessage, how.source, how.timestamp, now);
          else if constexpr (is_for_writer<Kind>)
            to_writer(submessage, how.source, now);
        },
        decoder.submessage());
  }
  figures.verdicts.count(decoder.verdict());
}

}  // namespace takt::dds
