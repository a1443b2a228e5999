// SPDX-License-Identifier: Apache-2.0
// The nine transitions of an OPC UA Program as one table (OPC 10000-10, 4.2.3 and 5.2.4; core nodeset 1.05.03).
//
// Everything that asks "what may happen" asks here: the machine, the handshake, its observers, documentation.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "program/method.hpp"
#include "program/state.hpp"

namespace takt::program {

struct Transition {
  std::uint8_t number;  ///< TransitionNumber, 1 to 9
  std::string_view name;
  std::uint16_t node_id;                    ///< i=... in namespace 0
  std::uint16_t transition_number_node_id;  ///< of its TransitionNumber property
  State from;
  State to;
  /// The methods that cause it here. One method leads from one state to one state, so Reset does not cause 7.
  MethodSet causes;
  /// The HasCause references of the nodeset; they differ from `causes` in transition 7 only.
  MethodSet nodeset_causes;
  /// The Program itself may cause it (Part 10, Table 1; 1 by 4.2.10: a resource has arrived).
  bool internal;
};

/// Reset in Suspended causes 8, as the nodeset and v1.05 Table 7 say; Part 10 Table 1 calls 8 internal only.
/// Transition 4 has no method: a Program that ends by itself and is ready at once.
inline constexpr std::array<Transition, 9> transitions{{
    {1, "HaltedToReady", 2408, 2409, State::Halted, State::Ready, MethodSet{Method::Reset}, MethodSet{Method::Reset},
     true},
    {2, "ReadyToRunning", 2410, 2411, State::Ready, State::Running, MethodSet{Method::Start}, MethodSet{Method::Start},
     false},
    {3, "RunningToHalted", 2412, 2413, State::Running, State::Halted, MethodSet{Method::Halt}, MethodSet{Method::Halt},
     true},
    {4, "RunningToReady", 2414, 2415, State::Running, State::Ready, MethodSet{}, MethodSet{}, true},
    {5, "RunningToSuspended", 2416, 2417, State::Running, State::Suspended, MethodSet{Method::Suspend},
     MethodSet{Method::Suspend}, false},
    {6, "SuspendedToRunning", 2418, 2419, State::Suspended, State::Running, MethodSet{Method::Resume},
     MethodSet{Method::Resume}, false},
    {7, "SuspendedToHalted", 2420, 2421, State::Suspended, State::Halted, MethodSet{Method::Halt},
     MethodSet{Method::Halt, Method::Reset}, false},
    {8, "SuspendedToReady", 2422, 2423, State::Suspended, State::Ready, MethodSet{Method::Reset},
     MethodSet{Method::Reset}, true},
    {9, "ReadyToHalted", 2424, 2425, State::Ready, State::Halted, MethodSet{Method::Halt}, MethodSet{Method::Halt},
     false},
}};

/// The transition with this number; nullptr if there is none.
constexpr const Transition* transition_with_number(std::uint32_t number) {
  return number >= 1 && number <= transitions.size() ? &transitions[number - 1] : nullptr;
}

namespace detail {
/// Numbers of transitions by (from, to) and by (from, method), 0 where there is none; derived from the table above.
struct Lookup {
  std::array<std::array<std::uint8_t, states.size()>, states.size()> between{};
  std::array<std::array<std::uint8_t, methods.size()>, states.size()> caused{};
  bool unique = true;
};

constexpr Lookup make_lookup() {
  Lookup lookup;
  for (const Transition& each : transitions) {
    std::uint8_t& between = lookup.between[index_of(each.from)][index_of(each.to)];
    lookup.unique = lookup.unique && between == 0 && each.from != each.to;
    between = each.number;
    for (const MethodInfo& method : methods) {
      if (!each.causes.contains(method.method)) continue;
      std::uint8_t& caused = lookup.caused[index_of(each.from)][index_of(method.method)];
      lookup.unique = lookup.unique && caused == 0;
      caused = each.number;
    }
  }
  return lookup;
}
inline constexpr Lookup lookup = make_lookup();
static_assert(lookup.unique, "one transition for a pair of states, and one for a method in a state");

constexpr bool transitions_are_complete() {
  for (std::size_t i = 0; i < transitions.size(); ++i) {
    const Transition& each = transitions[i];
    if (each.number != i + 1 || each.name.empty() || each.transition_number_node_id != each.node_id + 1) return false;
    if ((each.causes.bits & ~each.nodeset_causes.bits) != 0) return false;
  }
  return true;
}
static_assert(transitions_are_complete(), "transitions holds 1 to 9 in order and no cause that the nodeset has not");
}  // namespace detail

/// The transition that leads from one state to another; nullptr if no single transition does.
constexpr const Transition* transition_between(State from, State to) {
  return transition_with_number(detail::lookup.between[index_of(from)][index_of(to)]);
}

/// The same question as yes or no (and a constant expression for g++ 12 with sanitizers, which a compared pointer is
/// not).
constexpr bool transition_exists(State from, State to) {
  return detail::lookup.between[index_of(from)][index_of(to)] != 0;
}

/// The transition that a method causes in a state; nullptr where the method is not allowed.
constexpr const Transition* transition_caused_by(Method method, State from) {
  return transition_with_number(detail::lookup.caused[index_of(from)][index_of(method)]);
}

}  // namespace takt::program
