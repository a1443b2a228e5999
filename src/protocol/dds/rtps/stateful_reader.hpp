// SPDX-License-Identifier: Apache-2.0
// StatefulReader: takes the changes of matched writers in their order into its history, and asks reliable ones for what
// is missing (DDSI-RTPS 2.5, 8.4.10, 8.4.11.2, 8.4.12).
#pragma once

#include <deque>
#include <functional>
#include <map>

#include "dds/history/reader_history.hpp"
#include "dds/persistence/number_ranges.hpp"
#include "dds/rtps/epoch.hpp"
#include "dds/rtps/outbox.hpp"
#include "dds/rtps/timing_profile.hpp"
#include "dds/rtps/writer_proxy.hpp"

namespace takt::dds {

class StatefulReader {
 public:
  struct Settings {
    Guid guid;
    bool reliable = false;
    bool has_key = false;
    bool tracks_delivered =
        false;  ///< durability is TRANSIENT or above: what a persistence service brings counts as its writer's
    ReaderHistory::Settings history;
    TimingProfile timing;
    ReceiveLimits limits;
    Epoch epoch;
    /// Finds the instance of a payload whose writer sends no key hash; without it such changes belong to no_key.
    std::function<InstanceKey(PayloadKind, Octets)> key_of;
  };
  explicit StatefulReader(Settings settings) : settings_(std::move(settings)), history_(settings_.history) {}

  const Guid& guid() const { return settings_.guid; }
  const Settings& settings() const { return settings_; }
  ReaderHistory& history() { return history_; }
  const ReaderHistory& history() const { return history_; }

  void match(const MatchedWriter& writer, sim::LocalTime now);
  void unmatch(const Guid& writer, sim::LocalTime now);
  bool is_matched(const Guid& writer) const { return writers_.contains(writer); }
  const std::map<Guid, WriterProxy>& writers() const { return writers_; }

  /// `source`: the timestamp of the message; without one, samples count as written when they came.
  void receive(const Guid& writer, const Data& data, std::optional<Time> source, sim::LocalTime now, Outbox& outbox);
  void receive(const Guid& writer, const DataFrag& data, std::optional<Time> source, sim::LocalTime now,
               Outbox& outbox);
  void receive(const Guid& writer, const Heartbeat& heartbeat, sim::LocalTime now, Outbox& outbox);
  void receive(const Guid& writer, const HeartbeatFrag& heartbeat, sim::LocalTime now, Outbox& outbox);
  void receive(const Guid& writer, const Gap& gap, sim::LocalTime now, Outbox& outbox);

  std::optional<Sample> take(sim::LocalTime now, Outbox& outbox);

  sim::LocalTime next_wake() const;
  void wake(sim::LocalTime now, Outbox& outbox);

  /// Changes of this writer that were delivered before a restart. `writer` is an identity as of SampleInfo.
  void restore_delivered(const Guid& writer, const NumberRanges& numbers) {
    for (const auto& [first, last] : numbers.ranges()) delivered_of(writer).insert(first, last);
  }
  /// Writers whose delivered changes are remembered, also when they are gone: at most so many, besides those that are
  /// matched. Of one that is forgotten, the last to be heard of so many others ago, a persistence service may bring
  /// changes again.
  static constexpr std::size_t most_remembered = 1024;
  std::size_t remembered() const { return delivered_.size(); }

  /// The writer asserts that it is alive, by whatever its kind of liveliness asks for.
  void assert_alive(const Guid& writer, sim::LocalTime now);

  const SampleLostStatus& sample_lost() const { return lost_; }
  const LivelinessChangedStatus& liveliness_changed() const { return liveliness_; }
  /// Samples that went into the history since the last call.
  std::uint64_t drain_arrival_count() { return std::exchange(arrived_, 0); }
  /// Changes that came and were there already.
  std::uint64_t duplicates() const { return duplicates_; }

 private:
  void accept_change(WriterProxy& proxy, SequenceNumber number, PendingChange change, Octets payload,
                     sim::LocalTime now);
  /// False if the history has no room.
  bool deliver(WriterProxy& proxy, SequenceNumber number, const PendingChange& change, Octets payload,
               sim::LocalTime now);
  /// If the history has room again for what was turned away. What waits here is delivered.
  bool unblock(WriterProxy& proxy, sim::LocalTime now);
  void deliver_pending(WriterProxy& proxy, sim::LocalTime now);
  void lose_below(WriterProxy& proxy, SequenceNumber first, sim::LocalTime now);
  InstanceKey key_of(const InlineQos& qos, PayloadKind kind, Octets payload) const;
  bool is_wanted(const WriterProxy& proxy, SequenceNumber number) const;
  void plan_answer(WriterProxy& proxy, sim::Duration delay, bool is_final, sim::LocalTime now, Outbox& outbox);
  void answer(WriterProxy& proxy, bool is_final, sim::LocalTime now, Outbox& outbox);
  void alive(WriterProxy& proxy, sim::LocalTime now);
  NumberRanges& delivered_of(const Guid& identity);

  Settings settings_;
  ReaderHistory history_;
  std::map<Guid, WriterProxy> writers_;
  /// Of writers that may come back under another GUID, and of samples that a persistence service brings.
  std::map<Guid, NumberRanges> delivered_;
  std::deque<Guid> remembered_;  ///< those of delivered_, in the order in which they came
  SampleLostStatus lost_;
  LivelinessChangedStatus liveliness_;
  std::uint64_t arrived_ = 0;
  std::uint64_t duplicates_ = 0;
  std::uint32_t ack_count_ =
      0;  ///< counts go on from here where a writer is matched again, so that it does not take them for old ones
};

}  // namespace takt::dds
