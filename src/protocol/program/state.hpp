// SPDX-License-Identifier: Apache-2.0
// The four states of an OPC UA Program (OPC 10000-10, 5.2.3) and the INIT substate of a distributed Program.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>

namespace takt::program {

/// A state of ProgramStateMachineType. The value is the state's StateNumber.
enum class State : std::uint8_t { Halted = 11, Ready = 12, Running = 13, Suspended = 14 };

/// What the core nodeset says about a state.
struct StateInfo {
  State state;
  std::string_view name;               ///< BrowseName
  std::uint16_t node_id;               ///< i=... in namespace 0
  std::uint16_t state_number_node_id;  ///< of its StateNumber property
};

/// All states in the order of their StateNumber.
inline constexpr std::array<StateInfo, 4> states{{
    {State::Halted, "Halted", 2406, 2407},
    {State::Ready, "Ready", 2400, 2401},
    {State::Running, "Running", 2402, 2403},
    {State::Suspended, "Suspended", 2404, 2405},
}};

constexpr std::uint8_t number_of(State state) { return static_cast<std::uint8_t>(state); }
/// Position in `states`, 0 to 3. The state must be one of the four.
constexpr std::size_t index_of(State state) { return std::size_t{number_of(state)} - number_of(State::Halted); }
constexpr const StateInfo& info(State state) { return states[index_of(state)]; }
constexpr std::string_view name_of(State state) { return info(state).name; }

/// The state with this StateNumber; nothing if there is none.
constexpr std::optional<State> state_from_number(std::uint32_t number) {
  for (const StateInfo& each : states)
    if (number_of(each.state) == number) return each.state;
  return std::nullopt;
}

namespace detail {
constexpr bool states_are_complete() {
  for (std::size_t i = 0; i < states.size(); ++i)
    if (index_of(states[i].state) != i || states[i].name.empty()) return false;
  return true;
}
static_assert(states_are_complete(), "states holds every State, in the order of the numbers");
}  // namespace detail

}  // namespace takt::program
