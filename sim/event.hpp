// SPDX-License-Identifier: Apache-2.0
// The event record and the total order of events.
//
// An event is a plain record of 32 octets: no closure, no allocation. Two events are ordered by
//   (time, stage, node, phase, source, serial of the source)
// which depends neither on the order in which they were scheduled nor on nodes that are not concerned, so that
// a run in parallel could give the same run. The stage is control, nodes or judgement (see Phase). A node is a group of
// components: what happens to it at one instant is one run of events, without those of other nodes in between.
#pragma once

#include <cstdint>

#include "sim/time.hpp"

namespace takt::sim {

/// Dense index of a component of a simulation; at most 2^29 of them. Several components may be one node, which has the
/// id of one of them.
struct ComponentId {
  std::uint32_t index = 0;
  constexpr auto operator<=>(const ComponentId&) const = default;
};
inline constexpr std::uint32_t max_components = 1u << 29;

/// What happens first when several things happen at one instant. Control comes before the events of all nodes,
/// judgement behind them. The other phases order the events of a node. When the last of them has been handled, the
/// components of the node that asked for it *decide* (Component::decide): they see everything that arrived.
enum class Phase : std::uint8_t {
  control = 0,  ///< scripts, faults, clock steps, gate changes
  arrival,      ///< frames reach a node; a medium becomes free
  timer,        ///< applications and protocols wake up; they see all that arrived at the same instant
  decision,     ///< a component decides at whose node nothing else need happen
  judgement,    ///< monitors compare nodes; they cause nothing
};

/// The kind of an event. Each component type numbers its own kinds.
using EventKind = std::uint16_t;

/// Copied word by word, and takt is built without vectorising such copies: an event is read moments after it was
/// written, and a 16-octet load cannot be served from two 8-octet stores that are still on their way to the cache.
struct Event {
  Event() = default;
  Event(TrueTime time_, std::uint64_t order_, std::uint64_t serial_kind_, std::uint64_t argument_)
      : time(time_), order(order_), serial_kind(serial_kind_), argument(argument_) {}
  Event(const Event& other)
      : time(other.time), order(other.order), serial_kind(other.serial_kind), argument(other.argument) {}
  Event& operator=(const Event& other) {
    time = other.time;
    order = other.order;
    serial_kind = other.serial_kind;
    argument = other.argument;
    return *this;
  }

  TrueTime time;
  std::uint64_t order = 0;  ///< stage (2 bits), node (29), phase (2), whether it is for its source (1), source (29)
  std::uint64_t serial_kind = 0;  ///< serial of the source (48 bits), kind (16)
  std::uint64_t argument = 0;     ///< meaning given by the kind

  /// Of an event for the component whose id the node has.
  static constexpr std::uint64_t order_of(Phase phase, ComponentId node, ComponentId source) {
    constexpr std::uint64_t of_phase[] = {
        0, std::uint64_t{1} << stage_shift, std::uint64_t{1} << stage_shift | std::uint64_t{1} << phase_shift,
        std::uint64_t{1} << stage_shift | std::uint64_t{2} << phase_shift, std::uint64_t{2} << stage_shift};
    return of_phase[static_cast<std::size_t>(phase)] | static_cast<std::uint64_t>(node.index) << node_shift |
           source.index;
  }
  /// Of an event of a component for itself, which belongs to `node`.
  static constexpr std::uint64_t own_order_of(Phase phase, ComponentId node, ComponentId source) {
    return order_of(phase, node, source) | is_own;
  }
  static constexpr Phase phase_of(std::uint64_t order) {
    const std::uint64_t stage = order >> stage_shift;
    return stage == 0   ? Phase::control
           : stage == 2 ? Phase::judgement
                        : static_cast<Phase>(1 + (order >> phase_shift & 3));
  }
  /// The same of an event of a node in another phase of it.
  static constexpr std::uint64_t with_phase(std::uint64_t order, Phase phase) {
    return (order & ~(std::uint64_t{3} << phase_shift)) | (static_cast<std::uint64_t>(phase) - 1) << phase_shift;
  }
  static constexpr int source_bits = 29;
  static constexpr std::uint64_t id_mask = (1ULL << source_bits) - 1;
  static constexpr std::uint64_t is_own = 1ULL << source_bits;
  static constexpr int phase_shift = 30;
  static constexpr int node_shift = 32;
  static constexpr int stage_shift = 61;
  /// Stage and node: alike in the events of one node at an instant.
  static constexpr std::uint64_t place_of(std::uint64_t order) { return order >> node_shift; }

  constexpr EventKind kind() const { return static_cast<EventKind>(serial_kind & 0xFFFF); }
  constexpr ComponentId node() const { return {static_cast<std::uint32_t>(order >> node_shift & id_mask)}; }
  constexpr ComponentId source() const { return {static_cast<std::uint32_t>(order & id_mask)}; }
  /// Who handles it.
  constexpr ComponentId target() const {
    return {static_cast<std::uint32_t>(((order & is_own) != 0 ? order : order >> node_shift) & id_mask)};
  }

  friend constexpr bool operator<(const Event& a, const Event& b) {
    if (a.time != b.time) [[likely]]
      return a.time < b.time;
    if (a.order != b.order) return a.order < b.order;
    return a.serial_kind < b.serial_kind;
  }
};
static_assert(sizeof(Event) == 32);

/// The identity under which a component schedules events, with its own count of them.
class EventSource {
 public:
  EventSource() = default;
  explicit EventSource(ComponentId id) : id_(id) {}
  ComponentId id() const { return id_; }
  /// How many events it has scheduled.
  std::uint64_t count() const { return serial_word_ >> 16; }
  /// The serial of the next event, where Event keeps it. 2^48 events of one source do not occur.
  std::uint64_t next_serial_word() {
    const std::uint64_t word = serial_word_;
    serial_word_ += 1 << 16;
    return word;
  }

 private:
  std::uint64_t serial_word_ = 0;  ///< serial of the next event, moved by the 16 bits of the kind
  ComponentId id_;
};

}  // namespace takt::sim
