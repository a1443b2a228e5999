// SPDX-License-Identifier: Apache-2.0
// A stream gate of per-stream filtering and policing (IEEE 802.1Q clauses 8.6.5.4 and 8.6.10): open or closed, with an
// internal priority value, on the same cyclic time as a transmission gate.
#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "models/egress/cyclic_schedule.hpp"
#include "models/ethernet/frame.hpp"

namespace takt::models {

/// One operation SetGateAndIPV (Table 8-4).
struct StreamGateEntry {
  bool open = true;
  std::optional<Priority> ipv;                      ///< none: the frame's own priority decides the queue
  sim::Duration interval;                           ///< zero counts as one tick of 1 ns
  std::optional<std::uint32_t> interval_octet_max;  ///< MSDU octets that may pass in this interval; none: any number
  bool operator==(const StreamGateEntry&) const = default;
};

/// The entries of a stream gate with their cycle time. Immutable; gates share it.
class StreamGateList {
 public:
  /// The list has 1 to 65536 entries, and intervals and cycle time are in range (see CyclicIntervals): checked by the
  /// scenario.
  StreamGateList(std::span<const StreamGateEntry> entries, sim::Duration cycle_time);

  const CyclicIntervals& intervals() const { return intervals_; }
  sim::Duration cycle_time() const { return intervals_.cycle_time(); }
  std::span<const StreamGateEntry> entries() const { return entries_; }

 private:
  CyclicIntervals intervals_;
  std::vector<StreamGateEntry> entries_;
};

/// What a stream gate does with a frame of an instant.
struct StreamGateState {
  bool open = true;
  std::optional<Priority> ipv;
  std::optional<std::uint32_t> interval_octet_max;
  /// When the operation in force was executed: names this run of this entry and no other. An entry that stays because
  /// the list is shorter than its cycle, or because its cycle is stretched, stays the same run.
  sim::LocalTime interval_start;
  bool operator==(const StreamGateState&) const = default;
};

/// Counts the octets of the present interval against interval_octet_max (8.6.5.4). An operation fills the account
/// again.
class IntervalOctets {
 public:
  /// True if an MSDU of that many octets still fits; it is taken off then, and nothing is otherwise.
  bool take(const StreamGateState& state, std::uint32_t octets) {
    if (!state.interval_octet_max) return true;
    if (state.interval_start != interval_start_) {
      interval_start_ = state.interval_start;
      octets_left_ = *state.interval_octet_max;
    }
    if (octets > octets_left_) return false;
    octets_left_ -= octets;
    return true;
  }

 private:
  sim::LocalTime interval_start_ = sim::LocalTime::never();
  std::uint32_t octets_left_ = 0;
};

/// One stream gate as a function of the node's time, with the change of lists that transmission gates have (8.6.9).
/// Before the first list runs it is as admin_gate_open and admin_ipv say. `now` does not decrease from call to call.
class StreamGateSchedule {
 public:
  using AdminConfig = CyclicSchedule<StreamGateList>::AdminConfig;

  explicit StreamGateSchedule(bool admin_gate_open = true, std::optional<Priority> admin_ipv = std::nullopt)
      : admin_gate_open_(admin_gate_open), admin_ipv_(admin_ipv) {}

  /// Management sets ConfigChange. The list outlives the schedule. A request while a change is pending takes its place.
  ConfigChange request_change(sim::LocalTime now, const AdminConfig& admin);

  StreamGateState state(sim::LocalTime now);
  /// The entry in force, or null before the first list.
  const StreamGateEntry* entry(sim::LocalTime now) {
    const Schedule::Place& place = here(now);
    const StreamGateList* const list = schedule_.present().list;
    return list == nullptr ? nullptr : &list->entries()[place.entry];
  }
  bool admin_gate_open() const { return admin_gate_open_; }
  std::optional<Priority> admin_ipv() const { return admin_ipv_; }
  /// The first instant after `now` at which an operation is executed or another list begins; never() if none is.
  sim::LocalTime next_operation(sim::LocalTime now);

  const StreamGateList* oper_control_list(sim::LocalTime now) {
    here(now);
    return schedule_.oper_control_list();
  }
  bool config_pending(sim::LocalTime now) {
    here(now);
    return schedule_.config_pending();
  }
  sim::LocalTime config_change_time() const { return schedule_.config_change_time(); }
  std::uint64_t config_change_error() const { return schedule_.config_change_error(); }

 private:
  using Schedule = CyclicSchedule<StreamGateList>;

  const Schedule::Place& here(sim::LocalTime now) {
    if (!schedule_.is_at(now)) [[unlikely]]
      schedule_.move_to(now);
    return schedule_.here();
  }

  Schedule schedule_;
  bool admin_gate_open_;
  std::optional<Priority> admin_ipv_;
};

}  // namespace takt::models
