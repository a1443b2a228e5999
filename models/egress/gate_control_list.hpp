// SPDX-License-Identifier: Apache-2.0
// What the transmission gates of a port do in one cycle (IEEE 802.1Q clauses 8.6.8.4 and 8.6.9.2, Table 8-7).
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "models/egress/cyclic_schedule.hpp"
#include "models/ethernet/frame.hpp"

namespace takt::models {

/// Operation names, with the numbers of IEEE8021-ST-MIB.
enum class GateOperation : std::uint8_t {
  set_gate_states = 0,
  set_and_hold_mac = 1,     ///< the same, and from this entry on the MAC holds preemptable frames
  set_and_release_mac = 2,  ///< the same, and from this entry on it does not
};

/// Bit q is 1 if the gate of traffic class q is open.
using GateStates = std::uint8_t;
inline constexpr GateStates all_gates_open = 0xFF;

struct GateControlEntry {
  GateOperation operation = GateOperation::set_gate_states;
  GateStates gate_states = all_gates_open;
  sim::Duration interval;  ///< zero counts as one tick of 1 ns
  bool operator==(const GateControlEntry&) const = default;
};

/// The part of the cycle in which a gate is open, as an exact ratio.
struct OpenShare {
  sim::Duration open;
  sim::Duration cycle;
  bool operator==(const OpenShare&) const = default;
};

/// A list with its cycle time, laid out so that a question about a gate costs one look at one entry. Immutable; ports
/// share it.
class GateControlList {
 public:
  /// Says of a gate that it keeps its state for ever.
  static constexpr std::int64_t no_toggle_ps = std::numeric_limits<std::int64_t>::max();

  /// What a gate does during and after one entry of a regular cycle. Instants count from the start of the cycle in
  /// which the entry lies; those after its end lie in one of the next two.
  struct Ahead {
    std::int64_t toggle_ps = no_toggle_ps;  ///< when the gate next takes its other state
    std::int64_t next_open_ps = 0;          ///< when it next opens; nothing if next_window_ps < 0
    std::int64_t next_window_ps = -1;       ///< for how long it is open then; negative if it never opens again
    std::uint16_t toggled_by = 0;           ///< the entry that makes the toggle
    bool open = false;
  };

  /// The list has 1 to 65536 entries, and intervals and cycle time are in range (see CyclicIntervals): checked by the
  /// scenario.
  GateControlList(std::span<const GateControlEntry> entries, sim::Duration cycle_time);

  const CyclicIntervals& intervals() const { return intervals_; }
  sim::Duration cycle_time() const { return intervals_.cycle_time(); }
  /// The entries as given, with those that a regular cycle cuts off.
  std::span<const GateControlEntry> entries() const { return entries_; }
  const Ahead& ahead(std::uint32_t entry, TrafficClass q) const { return ahead_[entry * traffic_class_count + q]; }
  /// In an executed entry the MAC holds, if the cycle is not the first one or an entry up to this one has said so.
  bool holds(std::uint32_t entry) const { return holds_[entry]; }

  /// A stretch in which a gate is open without a break; instants count from the start of a regular cycle.
  struct Window {
    std::int64_t from_ps = 0;
    std::int64_t until_ps = 0;
  };
  /// The windows of a gate that begin in a cycle, ascending; before them the one that goes on from the cycle before, if
  /// there is one. A gate that is always open has one window that holds everything.
  std::span<const Window> windows(TrafficClass q) const {
    return {windows_.data() + first_window_[q], first_window_[q + 1u] - first_window_[q]};
  }

  /// How long the gate is open in a regular cycle.
  OpenShare open_share(TrafficClass q) const { return {open_[q], cycle_time()}; }
  /// The longest time for which the gate is open without a break while the list repeats; zero if it never opens,
  /// Duration::max() if it never closes. A guard for queue_max_sdu: a longer frame can never be sent.
  sim::Duration longest_window(TrafficClass q) const { return longest_window_[q]; }
  /// The first executed entry that holds or releases the MAC; intervals().executed() if none does.
  std::uint32_t first_hold_or_release() const { return first_hold_or_release_; }

 private:
  void lay_out_gate(TrafficClass q);
  void lay_out_windows(TrafficClass q);
  void lay_out_hold();

  std::vector<Ahead> ahead_;  // for each executed entry, each gate
  std::vector<Window> windows_;
  std::array<std::size_t, traffic_class_count + 1> first_window_{};
  CyclicIntervals intervals_;
  std::vector<GateControlEntry> entries_;
  std::vector<bool> holds_;
  std::array<sim::Duration, traffic_class_count> open_{};
  std::array<sim::Duration, traffic_class_count> longest_window_{};
  std::uint32_t first_hold_or_release_ = 0;
};

}  // namespace takt::models
