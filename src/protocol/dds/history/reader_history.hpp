// SPDX-License-Identifier: Apache-2.0
// ReaderHistory: what a reader has received and its application has not taken yet (DDS 1.4, 2.2.2.5;
// DDSI-RTPS 2.5, 8.2.2).
#pragma once

#include <functional>
#include <map>
#include <optional>
#include <set>
#include <vector>

#include "dds/history/cache_change.hpp"
#include "dds/history/deadline_table.hpp"
#include "dds/history/history_settings.hpp"
#include "dds/history/sample.hpp"
#include "dds/history/status.hpp"
#include "dds/message/guid.hpp"

namespace takt::dds {

/// A change on its way into a reader's history.
struct Arrival {
  Guid writer;
  std::int32_t ownership_strength = 0;
  SequenceNumber number;
  ChangeKind kind = ChangeKind::alive;
  InstanceKey key{};
  sim::LocalTime source;
  sim::LocalTime expires = sim::LocalTime::never();
  Octets payload;
  bool is_past = false;  ///< brought by a persistence service: must not replace what is newer
  Guid identity{};       ///< of the writer, as SampleInfo tells it
};

/// What became of an arrival. What is `rejected` may come again when there is room; of all others the reader has seen
/// the last.
enum class Admission : std::uint8_t { accepted, filtered, not_owner, expired, outdated, rejected };

class ReaderHistory {
 public:
  struct Settings {
    HistorySettings history;
    bool exclusive = false;                         ///< OWNERSHIP
    bool by_source = false;                         ///< DESTINATION_ORDER
    std::function<bool(Octets)> passes;             ///< content filter; nothing: all do
    sim::Duration minimum_separation{};             ///< TIME_BASED_FILTER, per instance, by reception
    sim::Duration deadline = sim::Duration::max();  ///< requested
    ReaderDataLifecycle data_lifecycle;
  };
  explicit ReaderHistory(const Settings& settings) : settings_(settings), deadlines_(settings.deadline) {}

  Admission add(const Arrival& arrival, sim::LocalTime now);
  /// Whether a change of this instance would not be rejected.
  bool has_room(const InstanceKey& key, sim::LocalTime now);
  /// The sample that is first in the destination order. It leaves the history.
  std::optional<Sample> take(sim::LocalTime now);
  /// All samples that are there, in the destination order. They stay, and are no longer NOT_READ.
  std::vector<Sample> read(sim::LocalTime now);
  bool has_samples() const { return !samples_.empty() || !invalid_.empty(); }
  std::size_t size() const { return samples_.size(); }
  std::size_t instances() const { return instances_.size(); }

  /// The writer is no longer matched, or lost its liveliness: others may own its instances; those that have no other
  /// writer are NOT_ALIVE_NO_WRITERS until one writes again.
  void writer_gone(const Guid& writer, sim::LocalTime now);

  sim::LocalTime next_deadline() const { return deadlines_.next(); }
  /// Instances that are due miss their deadline, and lose their owner by it.
  void advance(sim::LocalTime now);

  /// Samples that did not pass the content filter.
  std::uint64_t filtered() const { return filtered_; }
  const SampleRejectedStatus& sample_rejected() const { return rejected_; }
  const DeadlineMissedStatus& deadline_missed() const { return deadline_missed_; }
  /// The owner of an instance, if OWNERSHIP is EXCLUSIVE and it has one.
  std::optional<Guid> owner_of(const InstanceKey& key) const;

 private:
  /// The destination order. By reception: the number of the arrival. By source: time, then writer, then number.
  struct Place {
    std::int64_t major = 0;
    Guid writer;
    SequenceNumber number;
    auto operator<=>(const Place&) const = default;
  };
  struct Instance {
    InstanceState state = InstanceState::alive;
    bool is_new = true;  ///< nothing of this generation was read yet
    std::uint32_t disposed_generations = 0;
    std::uint32_t no_writers_generations = 0;
    std::set<Place> places;
    std::set<Guid> writers;
    std::optional<std::pair<std::int32_t, Guid>> owner;  ///< its strength and name
    std::optional<sim::LocalTime> accepted;              ///< the last one that passed the time-based filter
    sim::LocalTime newest;                               ///< source timestamp of the newest that was accepted
    std::optional<Place> taken;                          ///< the last one that the application took
    std::optional<Place> invalid;                        ///< the sample that tells how it ended
    sim::LocalTime purge_at = sim::LocalTime::never();   ///< autopurge of what has ended
  };
  struct Stored {
    Sample sample;  ///< instance_state and is_new_instance are filled in when it is read
    sim::LocalTime expires = sim::LocalTime::never();
  };
  using Instances = std::map<InstanceKey, Instance>;

  std::optional<RejectedBy> obstacle(const Instances::iterator& at) const;
  Place place_of(const Arrival& arrival) const;
  bool may_write(const Instance& instance, const Arrival& arrival) const;
  Admission end(Instances::iterator at, const Arrival& arrival, sim::LocalTime now);
  void leave(Instances::iterator at, InstanceState state, const Stored& told);
  void revive(Instance& instance);
  Admission reject(RejectedBy reason, const InstanceKey& key);
  void remove(std::map<Place, Stored>::iterator stored);
  void purge(sim::LocalTime now);
  void forget_if_over(Instances::iterator at);

  Settings settings_;
  Instances instances_;
  std::map<Place, Stored> samples_;
  std::map<Place, Stored> invalid_;  ///< what became of an instance, without data; at most one per instance
  std::set<std::pair<sim::LocalTime, Place>> expiries_;
  std::set<std::pair<sim::LocalTime, InstanceKey>> purges_;
  DeadlineTable deadlines_;
  std::int64_t arrivals_ = 0;
  std::uint64_t filtered_ = 0;
  SampleRejectedStatus rejected_;
  DeadlineMissedStatus deadline_missed_;
};

}  // namespace takt::dds
