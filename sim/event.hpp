// The event record and the total order of events.
//
// An event is a plain record of 32 octets: no closure, no allocation. Two events are ordered by
//   (time, phase, target, source, serial of the source)
// which depends neither on the order in which they were scheduled nor on components that are not concerned, so that
// a run in parallel could give the same run.
#pragma once

#include <cstdint>

#include "sim/time.hpp"

namespace takt::sim {

/// Dense index of a component of a simulation; at most 2^30 of them.
struct ComponentId {
  std::uint32_t index = 0;
  constexpr auto operator<=>(const ComponentId&) const = default;
};
inline constexpr std::uint32_t max_components = 1u << 30;

/// What happens first when several things happen at one instant. After all phases of an instant the components that
/// asked for it *settle* (Component::settle): they see everything that arrived and decide once.
enum class Phase : std::uint8_t {
  control = 0,  ///< scripts, faults, clock steps, gate changes
  arrival = 1,  ///< frames reach a node; a medium becomes free
  timer = 2,    ///< applications and protocols wake up; they see all that arrived at the same instant
};

/// What a component is told; each component type numbers its own kinds.
using EventKind = std::uint16_t;

/// Copied word by word, and takt is built without vectorising such copies: an event is read moments after it was written,
/// and a 16-octet load cannot be served from two 8-octet stores that are still on their way to the cache.
struct Event {
  Event() = default;
  Event(TrueTime time_, std::uint64_t order_, std::uint64_t serial_kind_, std::uint64_t argument_)
      : time(time_), order(order_), serial_kind(serial_kind_), argument(argument_) {}
  Event(const Event& other) : time(other.time), order(other.order), serial_kind(other.serial_kind), argument(other.argument) {}
  Event& operator=(const Event& other) {
    time = other.time;
    order = other.order;
    serial_kind = other.serial_kind;
    argument = other.argument;
    return *this;
  }

  TrueTime time;
  std::uint64_t order = 0;        ///< phase (4 bits), target (30), source (30)
  std::uint64_t serial_kind = 0;  ///< serial of the source (48 bits), kind (16)
  std::uint64_t argument = 0;     ///< meaning given by the kind

  static constexpr std::uint64_t order_of(Phase phase, ComponentId target, ComponentId source) {
    return static_cast<std::uint64_t>(phase) << 60 | static_cast<std::uint64_t>(target.index) << 30 | source.index;
  }
  static constexpr int source_bits = 30;
  static constexpr std::uint64_t pair_mask = (1ULL << 60) - 1;

  constexpr EventKind kind() const { return static_cast<EventKind>(serial_kind & 0xFFFF); }
  constexpr ComponentId target() const { return {static_cast<std::uint32_t>(order >> 30) & (max_components - 1)}; }
  constexpr ComponentId source() const { return {static_cast<std::uint32_t>(order) & (max_components - 1)}; }

  friend constexpr bool operator<(const Event& a, const Event& b) {
    if (a.time != b.time) [[likely]] return a.time < b.time;
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
