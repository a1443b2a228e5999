// SPDX-License-Identifier: Apache-2.0
// StatefulWriter: sends the changes of its history to matched readers, to the reliable ones until they acknowledge
// (DDSI-RTPS 2.5, 8.4.7.4, 8.4.8.2, 8.4.9). Best-effort readers keep no state but how far they have been sent to.
#pragma once

#include <map>
#include <set>

#include "dds/history/writer_history.hpp"
#include "dds/message/fragments.hpp"
#include "dds/rtps/endpoint.hpp"
#include "dds/rtps/epoch.hpp"
#include "dds/rtps/outbox.hpp"
#include "dds/rtps/timing_profile.hpp"

namespace takt::dds {

class StatefulWriter {
 public:
  struct Settings {
    Guid guid;
    bool reliable = true;
    bool has_key = false;
    bool brings_others = false;  ///< changes of other writers, with PID_ORIGINAL_WRITER_INFO
    bool asynchronous = false;   ///< somebody else calls send_next
    WriterHistory::Settings history;
    TimingProfile timing;
    std::size_t max_message = 1472;  ///< octets of an RTPS message
    bool multicast_to_one = false;   ///< see ParticipantConfig
    std::int32_t transport_priority = 0;
    Epoch epoch;
  };
  explicit StatefulWriter(const Settings& settings);

  const Guid& guid() const { return settings_.guid; }
  const Settings& settings() const { return settings_; }
  WriterHistory& history() { return history_; }
  const WriterHistory& history() const { return history_; }

  /// A reader that is matched again under the same name begins anew.
  void match(const MatchedReader& reader, sim::LocalTime now, Outbox& outbox);
  void unmatch(const Guid& reader, sim::LocalTime now);
  bool is_matched(const Guid& reader) const { return readers_.contains(reader); }
  std::size_t matched() const { return readers_.size(); }
  /// Whether each reliable reader has acknowledged all.
  bool is_acknowledged() const;

  /// Precondition: the history has room. A synchronous writer sends at once.
  SequenceNumber write(ChangeKind kind, const InstanceKey& key, Octets payload, sim::LocalTime now, Outbox& outbox);
  /// The same of a change whose source is another writer.
  SequenceNumber write(CacheChange change, sim::LocalTime now, Outbox& outbox);
  void receive(const Guid& reader, const AckNack& ack, sim::LocalTime now, Outbox& outbox);
  void receive(const Guid& reader, const NackFrag& nack, sim::LocalTime now, Outbox& outbox);
  /// A HEARTBEAT that tells all readers that the writer is alive.
  void assert_liveliness(Outbox& outbox);

  sim::LocalTime next_wake() const;
  void wake(sim::LocalTime now, Outbox& outbox);

  /// Octets that the next message with data may have at most; 0: there is none. Sends GAPs for what is no longer there.
  std::size_t next_size(Outbox& outbox);
  /// Sends that message; gives its octets. Precondition: next_size() is not 0.
  std::size_t send_next(sim::LocalTime now, Outbox& outbox);
  /// The lowest number that some reader has not been sent; last + 1 if there is none.
  SequenceNumber first_unsent() const;
  /// Whether some but not all fragments of a sample have been sent.
  bool is_within_sample() const;

 private:
  struct ReaderProxy {
    MatchedReader reader;
    SequenceNumber start;  ///< what is before is none of its business
    SequenceNumber next_unsent;
    FragmentNumber next_fragment{1};
    SequenceNumber acknowledged_below;
    std::map<SequenceNumber, std::set<FragmentNumber>> requests;  ///< no fragments: the whole change
    std::map<SequenceNumber, sim::LocalTime> sent_at;             ///< for nack suppression
    sim::LocalTime respond_at = sim::LocalTime::never();
    sim::LocalTime heartbeat_at = sim::LocalTime::never();
    bool is_due = false;  ///< the response delay of its requests has passed
    std::uint32_t last_ack = 0;
    std::uint32_t last_nack_frag = 0;
  };
  using Readers = std::map<Guid, ReaderProxy>;
  /// The next message with data. No proxy: for all.
  struct Work {
    const CacheChange* change = nullptr;
    FragmentNumber fragment{0};  ///< 0: the change is sent whole
    ReaderProxy* only = nullptr;
    bool is_request = false;
  };

  std::optional<Work> next_work(Outbox& outbox);
  std::optional<Work> next_request(Outbox& outbox);
  std::optional<Work> next_unsent(Outbox& outbox);
  std::size_t size_of_work(const Work& work) const;
  std::size_t transmit(const Work& work, sim::LocalTime now, Outbox& outbox);
  void advance(ReaderProxy& proxy, const CacheChange& change, FragmentNumber fragment, sim::LocalTime now);
  void ask(ReaderProxy& proxy, SequenceNumber number, sim::LocalTime now, const FragmentNumberSet* fragments = nullptr);
  void answer_later(ReaderProxy& proxy, sim::LocalTime now, Outbox& outbox);
  void gap(const ReaderProxy& proxy, SequenceNumber from, SequenceNumber to, Outbox& outbox);
  bool is_behind(const ReaderProxy& proxy) const;
  bool is_anyone_behind() const;
  Heartbeat heartbeat(const ReaderProxy* only);
  void add_heartbeat(const ReaderProxy& proxy, Outbox& outbox);
  void send_heartbeat(const ReaderProxy& proxy, Outbox& outbox);
  void send_heartbeats(sim::LocalTime now, Outbox& outbox);
  void piggyback(const Work& work, sim::LocalTime now, Outbox& outbox);
  void push(sim::LocalTime now, Outbox& outbox);
  void release();
  void plan_heartbeat(sim::LocalTime now);
  bool is_fragmented(const CacheChange& change) const { return change.payload.size() > most_payload_; }
  std::uint32_t fragments_of_change(const CacheChange& change) const;
  InlineQos inline_qos(const CacheChange& change) const;
  Route route_to(const ReaderProxy& proxy) const;
  void plan_route();

  Settings settings_;
  WriterHistory history_;
  Readers readers_;
  Route route_to_all_;
  std::size_t most_payload_ = 0;  ///< octets that a DATA can carry
  std::uint16_t fragment_size_ = 0;
  std::uint32_t heartbeat_count_ = 0;
  std::uint32_t heartbeat_frag_count_ = 0;
  std::uint32_t heartbeats_since_write_ = 0;
  sim::LocalTime heartbeat_at_ = sim::LocalTime::never();
  std::optional<sim::LocalTime> piggybacked_at_;
  std::optional<sim::LocalTime> asked_at_;
};

}  // namespace takt::dds
