// ParticipantMessages: participants tell each other that they are alive, for the liveliness of their writers (DDSI-RTPS 2.5, 8.4.13).
#pragma once

#include "dds/discovery/data.hpp"
#include "dds/rtps/stateful_reader.hpp"
#include "dds/rtps/stateful_writer.hpp"

namespace takt::dds {

/// The built-in writer and reader of participant messages: reliable, transient-local, KEEP_LAST 1 per participant and kind.
class ParticipantMessages {
 public:
  ParticipantMessages(const GuidPrefix& prefix, const TimingProfile& timing, std::size_t max_message, Epoch epoch);

  void add_peer(const GuidPrefix& peer, const std::vector<Locator>& metatraffic, sim::LocalTime now, Outbox& outbox);
  void remove_peer(const GuidPrefix& peer, sim::LocalTime now);

  /// The shortest lease of all local writers of this kind of liveliness; infinite: there is none that needs messages.
  void set_lease(LivelinessKind kind, sim::Duration lease, sim::LocalTime now);
  /// MANUAL_BY_PARTICIPANT: the application says so.
  void assert_manual(sim::LocalTime now, Outbox& outbox) { send(ParticipantMessageData::Kind::manual, now, outbox); }

  StatefulWriter& writer() { return writer_; }
  StatefulReader& reader() { return reader_; }

  sim::LocalTime next_wake() const;
  void wake(sim::LocalTime now, Outbox& outbox);
  /// The next message that came, if it could be read.
  std::optional<ParticipantMessageData> take(sim::LocalTime now, Outbox& outbox);

 private:
  void send(ParticipantMessageData::Kind kind, sim::LocalTime now, Outbox& outbox);

  GuidPrefix prefix_;
  std::uint32_t percent_;
  StatefulWriter writer_;
  StatefulReader reader_;
  sim::Duration period_ = infinite;
  sim::LocalTime send_at_ = sim::LocalTime::never();
};

}  // namespace takt::dds
