// SPDX-License-Identifier: Apache-2.0
// What automatic gates are laid for, and what is laid: plain values, so that other ways to a schedule can take the same
// problem and the checker (schedule_check/check.hpp) judges them all.
//
// Times are those of the synchronised clocks. The windows of a stream repeat with its period; `GateList`s begin at 0.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "models/egress/gate_control_list.hpp"
#include "models/ethernet/frame.hpp"
#include "sim/time.hpp"

namespace takt::scenario {

/// Greatest number of entries of a gate control list.
inline constexpr std::size_t most_gate_entries = 1024;

/// What a port takes as a gate control list.
struct ListLimits {
  std::size_t entries = most_gate_entries;                       ///< at most
  sim::Duration least_interval = sim::Duration::from_ps(1'000);  ///< no entry is shorter
  sim::Duration granularity = sim::Duration::from_ps(1'000);     ///< cycle and entries are multiples of it
  bool operator==(const ListLimits&) const = default;
};

/// A port that scheduled frames cross.
struct GatedPort {
  models::NodeIndex node;
  std::uint16_t port = 0;
  std::string name;                 ///< "sw1 to sw2", for people
  sim::Duration gap;                ///< the inter-packet gap at the link's rate
  sim::Duration guard;              ///< for how long before a window the other classes are closed; at least the gap
  ListLimits limits{};              ///< of its device
  sim::Octets longest_frame{1522};  ///< that the node passes, with a tag
  bool operator==(const GatedPort&) const = default;
};

/// A stream crosses a port.
struct ScheduledHop {
  std::uint32_t port = 0;                 ///< in GateProblem::ports
  std::optional<std::uint32_t> previous;  ///< the hop before, a lower index in the stream; empty at the talker
  models::TrafficClass traffic_class = 0;
  sim::Duration transmission;  ///< preamble to FCS
  sim::Duration behind;        ///< last bit sent to ready at the next port: propagation and forwarding delay
  sim::Duration
      wait{};  ///< behind another copy of the same frame; of streams with windows those at their talker tell it
  sim::Duration ahead{};   ///< cut through: it begins so long before its last bit is there
  bool is_merged = false;  ///< behind a merge of copies: of the hops of its stream at this port each frame takes one
  bool operator==(const ScheduledHop&) const = default;
};

/// One frame a period.
struct ScheduledStream {
  std::string name;
  sim::Duration period;            ///< a whole number of ns
  sim::Duration release;           ///< by when the first frame is surely at the talker's port
  std::uint32_t train = 0;         ///< streams of one train are handed to the port in their order, at one instant
  std::vector<ScheduledHop> hops;  ///< the tree from the talker to all listeners; of a redundant stream with all ways,
                                   ///< each of them to its end
  sim::Duration early{};           ///< how long before its release, at most, a frame may be at the talker's port
  bool operator==(const ScheduledStream&) const = default;
};

struct GateProblem {
  sim::Duration margin;  ///< the clocks of any two nodes differ by at most this
  std::vector<GatedPort> ports;
  std::vector<ScheduledStream> streams;
  bool operator==(const GateProblem&) const = default;
};

/// Windows that are looked at for one list; where they take more entries than a port has, they are merged.
inline constexpr std::int64_t most_windows_of_a_list = 1 << 16;

/// Greatest cycle of a gate control list.
inline constexpr sim::Duration longest_gate_cycle = sim::Duration::from_ps(3'600'000'000'000'000);

/// For a stream at a hop: its frames begin at `start` + n * period, and the gate is open from `open` to `close` + n *
/// period.
struct StreamWindow {
  sim::Duration start;
  sim::Duration open;
  sim::Duration close;
  bool operator==(const StreamWindow&) const = default;
};

struct GateList {
  struct Entry {
    models::GateStates open = models::all_gates_open;
    sim::Duration interval;
    bool operator==(const Entry&) const = default;
  };
  sim::Duration cycle;
  std::vector<Entry> entries;
  bool operator==(const GateList&) const = default;
};

struct GateSolution {
  std::vector<std::vector<StreamWindow>> windows;  ///< by stream and hop
  std::vector<GateList> lists;                     ///< by port
  bool operator==(const GateSolution&) const = default;
};

/// Why a device cannot take a list, however it is changed.
enum class ListObstacle : std::uint8_t {
  none,
  cycle,    ///< it is no multiple of the granularity
  entries,  ///< even the shortest list is too long
  no_time,  ///< the other classes would never be open
  waiting,  ///< frames wait for their windows there, which must stay as they are
};

/// Why there is no schedule.
struct GateConflict {
  enum class Kind : std::uint8_t { overlap, cycle_too_long, order, limits };
  Kind kind = Kind::overlap;
  std::uint32_t first = 0;  ///< streams; the same one if it meets itself
  std::uint32_t second = 0;
  std::uint32_t port = 0;
  sim::Duration first_from;  ///< of an overlap: what they occupy; of an order: when they may come; an instance of each
                             ///< within the common cycle
  sim::Duration first_until;
  sim::Duration second_from;
  sim::Duration second_until;
  sim::Duration cycle;        ///< the common cycle, as far as it was worked out
  std::uint64_t entries = 0;  ///< of a cycle that is too long: at least so many; of limits: with so many it holds, if
                              ///< their number is what is wrong
  ListObstacle obstacle = ListObstacle::none;  ///< of limits
};

/// A problem and its solution, as a scenario keeps them.
struct GatePlan {
  GateProblem problem;
  GateSolution schedule;
  sim::Duration begins{};  ///< when the last of its lists does
};

}  // namespace takt::scenario
