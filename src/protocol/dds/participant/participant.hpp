// SPDX-License-Identifier: Apache-2.0
// Participant: a DDS DomainParticipant with its writers, readers and discovery. Sans-IO: it is fed with the octets of
// UDP payloads and local time, and polled for what it wants to send and to tell.
#pragma once

#include <deque>
#include <map>
#include <memory>
#include <set>

#include "dds/discovery/discovery.hpp"
#include "dds/participant/local_reader.hpp"
#include "dds/participant/local_writer.hpp"
#include "dds/rtps/flow_controller.hpp"

namespace takt::dds {

enum class WriteVerdict : std::uint8_t {
  written,
  would_block,  ///< the history is full: wait for the event `writable`, and write again
  refused,
};
struct WriteResult {
  WriteVerdict verdict = WriteVerdict::written;
  SequenceNumber number;                           ///< of what was written
  sim::LocalTime until = sim::LocalTime::never();  ///< of would_block: when the time-out is told
  std::string reason;                              ///< of refused
};

/// A message to be sent, to each of its destinations.
struct DatagramView {
  const std::vector<Locator>& destinations;
  Octets octets;  ///< a UDP payload; valid until the next call of the participant
  std::int32_t transport_priority = 0;
};

/// Settings of a participant that cannot be, each as "setting: what and why".
std::vector<std::string> problems_of(const ParticipantConfig& config);

/// Everything that happens at an instant happens in the order of entities' handles, of peers by GUID. No call blocks.
class Participant {
 public:
  /// Precondition: problems_of(config) is empty.
  Participant(const ParticipantConfig& config, sim::LocalTime now);
  Participant(const Participant&) = delete;
  ~Participant();

  const ParticipantConfig& config() const { return config_; }
  const GuidPrefix& prefix() const { return config_.prefix; }
  const Ports& ports() const { return ports_; }

  Created<WriterHandle> create_writer(const WriterConfig& config, sim::LocalTime now);
  Created<ReaderHandle> create_reader(const ReaderConfig& config, sim::LocalTime now);
  void remove(WriterHandle writer, sim::LocalTime now);
  void remove(ReaderHandle reader, sim::LocalTime now);

  /// `payload`: CDR with its encapsulation header; arrives filled up with zeros to a multiple of 4 octets. `key`:
  /// no_key in topics without key.
  WriteResult write(WriterHandle writer, const InstanceKey& key, Octets payload, sim::LocalTime now);
  /// `key_payload`: the key fields as CDR with encapsulation header, for readers that do not take key hashes; may be
  /// empty.
  WriteResult dispose(WriterHandle writer, const InstanceKey& key, sim::LocalTime now, Octets key_payload = {});
  /// Disposes, too, if the data lifecycle says so.
  WriteResult unregister(WriterHandle writer, const InstanceKey& key, sim::LocalTime now, Octets key_payload = {});
  /// Of a writer that brings others' changes: as `source` tells of it.
  WriteResult write_for(WriterHandle writer, const OriginalWriter& original, ChangeKind kind, const InstanceKey& key,
                        Octets payload, sim::LocalTime source, sim::LocalTime now);
  /// The oldest sample, which leaves the reader.
  std::optional<Sample> take(ReaderHandle reader, sim::LocalTime now);
  /// Of a reader that commits by hand: the sample is not wanted again after a restart.
  void commit(ReaderHandle reader, const SampleInfo& info) { local(reader).commit(info); }
  /// The reader has had this change of the writer, or of the one with this persistence GUID.
  void mark_delivered(ReaderHandle reader, const OriginalWriter& change);
  /// All samples, which stay.
  std::vector<Sample> read(ReaderHandle reader, sim::LocalTime now);
  /// MANUAL_BY_TOPIC: the writer's; MANUAL_BY_PARTICIPANT: that of all such writers of the participant.
  void assert_liveliness(WriterHandle writer, sim::LocalTime now);

  /// Takes leave of the others; nothing is announced any more.
  void stop(sim::LocalTime now);

  /// Where messages for this participant come to; groups have to be joined.
  std::vector<Locator> listens_to() const;
  /// `source` is where the message came from.
  void receive(Octets message, const Locator& source, sim::LocalTime now);
  sim::LocalTime next_wake() const;
  void wake(sim::LocalTime now);
  std::optional<DatagramView> next_datagram();
  std::optional<Event> next_event();

  /// Static matching: what discovery would have found out. QoS is compared in the same way.
  Matching match(WriterHandle writer, const SubscriptionData& remote, sim::LocalTime now);
  Matching match(ReaderHandle reader, const PublicationData& remote, sim::LocalTime now);
  void unmatch(WriterHandle writer, const Guid& remote, sim::LocalTime now);
  void unmatch(ReaderHandle reader, const Guid& remote, sim::LocalTime now);

  const PublicationData& data_of(WriterHandle writer) const { return writers_.at(writer.number)->data; }
  const SubscriptionData& data_of(ReaderHandle reader) const { return readers_.at(reader.number)->data; }
  const LocalWriter& writer(WriterHandle handle) const { return *writers_.at(handle.number); }
  const LocalReader& reader(ReaderHandle handle) const { return *readers_.at(handle.number); }
  const Figures& figures() const { return outbox_.figures(); }
  /// Nothing without discovery.
  const Discovery* discovery() const { return discovery_.get(); }

 private:
  LocalWriter& local(WriterHandle writer);
  LocalReader& local(ReaderHandle reader);
  WriteResult write(WriterHandle writer, CacheChange change, sim::LocalTime now);
  FlowController& flow_of(const WriterConfig& config, std::uint32_t number, sim::LocalTime now);
  void tell(EventKind kind, std::uint32_t entity, const Guid& remote, std::uint64_t count, sim::LocalTime now);
  void report_mismatch(const Matching& matching, std::uint32_t entity, const Guid& remote, std::uint64_t count,
                       sim::LocalTime now);
  /// After anything that happened: what was found, what goes to oneself, flow controllers, waiting writes, statuses.
  void settle(sim::LocalTime now);
  Matching try_match(LocalWriter& writer, const SubscriptionData& remote, const MatchedReader& reader,
                     sim::LocalTime now);
  Matching try_match(LocalReader& reader, const PublicationData& remote, const MatchedWriter& writer,
                     sim::LocalTime now);
  void end_match(LocalWriter& writer, const Guid& remote, sim::LocalTime now);
  void end_match(LocalReader& reader, const Guid& remote, sim::LocalTime now);
  void match_with_all(LocalWriter& writer, sim::LocalTime now);
  void match_with_all(LocalReader& reader, sim::LocalTime now);
  void accept_discovered(sim::LocalTime now);
  void accept_discovered(const DiscoveryEvent& event, sim::LocalTime now);
  void assert_writers_of(const GuidPrefix& participant, LivelinessKind kind, sim::LocalTime now);
  void plan_liveliness(sim::LocalTime now);
  void dispatch(Octets message, sim::LocalTime now);

  // Each kind of submessage to those that it concerns (participant_receive.cpp).
  template <class Submessage>
  void to_readers(const Submessage& submessage, const GuidPrefix& source, std::optional<Time> timestamp,
                  sim::LocalTime now);
  template <class Submessage>
  void to_writer(const Submessage& submessage, const GuidPrefix& source, sim::LocalTime now);

  ParticipantConfig config_;
  Ports ports_;
  Outbox outbox_;
  std::map<std::uint32_t, std::unique_ptr<LocalWriter>> writers_;
  std::map<std::uint32_t, std::unique_ptr<LocalReader>> readers_;
  std::map<EntityId, LocalWriter*> writers_by_id_;
  std::map<std::string, std::unique_ptr<FlowController>> flows_;
  std::unique_ptr<Discovery> discovery_;
  // Participant messages for writers whose liveliness is AUTOMATIC.
  sim::Duration liveliness_period_ = infinite;
  sim::LocalTime liveliness_at_ = sim::LocalTime::never();
  std::deque<Event> events_;
  std::uint32_t entities_ = 0;
};

}  // namespace takt::dds
