// SPDX-License-Identifier: Apache-2.0
// WriterHistory: what a writer keeps of what was written, until nobody needs it any more (DDSI-RTPS 2.5, 8.2.2).
#pragma once

#include <algorithm>
#include <functional>
#include <map>
#include <optional>
#include <set>

#include "dds/history/cache_change.hpp"
#include "dds/history/deadline_table.hpp"
#include "dds/history/history_settings.hpp"

namespace takt::dds {

/// Why a change finds no room.
enum class NoRoom : std::uint8_t { max_samples, max_samples_per_instance, max_instances };

/// KEEP_LAST replaces the oldest changes of an instance; KEEP_ALL replaces nothing that is not released. Changes are
/// *released* when all readers have acknowledged them. A volatile history drops what is released; a transient-local one
/// keeps it for late joiners and gives it up only where the limits leave no other way. An instance whose unregistration
/// is released is forgotten in both.
class WriterHistory {
 public:
  struct Settings {
    HistorySettings history;
    bool keeps_released = false;  ///< TRANSIENT_LOCAL and above
    sim::Duration lifespan = sim::Duration::max();
    sim::Duration deadline = sim::Duration::max();  ///< offered
    /// Told of each change that leaves; `is_last`: none has a higher number.
    std::function<void(SequenceNumber number, bool is_last)> removed;
  };
  explicit WriterHistory(const Settings& settings);

  /// What stands in the way of one more change of this instance now; nothing if it would be added.
  std::optional<NoRoom> obstacle(const InstanceKey& key, sim::LocalTime now);
  /// Precondition: no obstacle. The change gets the next number.
  const CacheChange& add(ChangeKind kind, const InstanceKey& key, std::span<const std::byte> payload,
                         sim::LocalTime now);
  /// The same of a change whose source is another writer. `change` gets its number here.
  const CacheChange& add(CacheChange change, sim::LocalTime now);
  /// Puts back a change that was kept elsewhere. Precondition: its number is above all others; it fits.
  void restore(CacheChange change);
  /// Numbers up to `last` were given away before a restart.
  void go_on_after(SequenceNumber last) { last_ = std::max(last_, last); }

  /// The change, if it is still there.
  const CacheChange* find(SequenceNumber number) const;
  /// The change with the lowest number that is at least `number`.
  const CacheChange* at_or_after(SequenceNumber number) const;
  /// The lowest number that is there; last() + 1 if nothing is.
  SequenceNumber first() const;
  SequenceNumber last() const { return last_; }
  std::size_t size() const { return changes_.size(); }
  std::size_t instances() const { return instances_.size(); }
  bool knows(const InstanceKey& key) const { return instances_.contains(key); }
  const std::map<SequenceNumber, CacheChange>& changes() const { return changes_; }

  /// Nobody asks any more for changes below `number`.
  void release(SequenceNumber number);
  /// Drops what has expired.
  void expire(sim::LocalTime now);
  sim::LocalTime next_expiry() const { return expiries_.empty() ? sim::LocalTime::never() : expiries_.begin()->first; }

  DeadlineTable& deadlines() { return deadlines_; }
  const DeadlineTable& deadlines() const { return deadlines_; }

 private:
  struct Instance {
    std::set<SequenceNumber> numbers;
    bool unregistered = false;
  };
  using Changes = std::map<SequenceNumber, CacheChange>;

  void place(CacheChange change);
  Changes::iterator remove(Changes::iterator change);
  Changes::iterator erase(Changes::iterator change);
  /// Removes the oldest released change of an instance, or of all; false if there is none.
  bool give_up(const Instance& instance);
  bool give_up_any();

  Settings settings_;
  Changes changes_;
  std::map<InstanceKey, Instance> instances_;
  std::set<std::pair<sim::LocalTime, SequenceNumber>> expiries_;
  DeadlineTable deadlines_;
  SequenceNumber last_;
  SequenceNumber released_below_ = first_sequence_number;
};

}  // namespace takt::dds
