// SPDX-License-Identifier: Apache-2.0
// A machine nested in one of the four states (OPC 10000-10, 4.2.4 and Annex A; HasSubStateMachine of OPC 10000-16).
//
// It lives while its parent state is active. Its numbers are its own: they may repeat those of the base machine.
#pragma once

#include <optional>
#include <span>

#include "program/state.hpp"
#include "program/status.hpp"
#include "sim/check.hpp"

namespace takt::program {

struct Substate {
  std::uint32_t number;  ///< StateNumber within the nested machine; above 0
  std::string_view name;
};

/// From or to 0 stands for the parent state with no substate.
struct Subtransition {
  std::uint32_t number;  ///< TransitionNumber within the nested machine; above 0
  std::string_view name;
  std::uint32_t from;
  std::uint32_t to;
};

/// What there is to a nested machine: a constant that somebody else owns.
struct NestedDescription {
  State parent;
  std::span<const Substate> substates = {};
  std::span<const Subtransition> transitions = {};
  /// The substate that is entered with the parent state; 0: none.
  std::uint32_t initial = 0;

  constexpr const Substate* substate(std::uint32_t number) const {
    for (const Substate& each : substates)
      if (each.number == number) return &each;
    return nullptr;
  }
  constexpr const Subtransition* between(std::uint32_t from, std::uint32_t to) const {
    for (const Subtransition& each : transitions)
      if (each.from == from && each.to == to) return &each;
    return nullptr;
  }
};

/// True if numbers and names are unique and above 0, and every transition joins what there is. (By positions: g++ 12
/// with sanitizers takes no comparison of pointers for a constant expression.)
constexpr bool is_sound(const NestedDescription& machine) {
  const auto exists = [&](std::uint32_t number) {
    bool found = number == 0;
    for (const Substate& each : machine.substates) found = found || each.number == number;
    return found;
  };
  for (std::size_t i = 0; i < machine.substates.size(); ++i) {
    const Substate& each = machine.substates[i];
    if (each.number == 0 || each.name.empty()) return false;
    for (std::size_t k = 0; k < i; ++k)
      if (machine.substates[k].number == each.number || machine.substates[k].name == each.name) return false;
  }
  for (std::size_t i = 0; i < machine.transitions.size(); ++i) {
    const Subtransition& each = machine.transitions[i];
    if (each.number == 0 || each.from == each.to || !exists(each.from) || !exists(each.to)) return false;
    for (std::size_t k = 0; k < i; ++k)
      if (machine.transitions[k].number == each.number) return false;
  }
  return exists(machine.initial);
}

/// INIT below Halted (paper, III.B), as a nested machine. Number 15 is what participants publish for it.
inline constexpr std::array<Substate, 1> init_substates{{{15, "Init"}}};
inline constexpr std::array<Subtransition, 2> init_transitions{
    {{1, "HaltedToInit", 0, 15}, {2, "InitToHalted", 15, 0}}};
inline constexpr NestedDescription init_machine{State::Halted, init_substates, init_transitions};

/// Where a nested machine is.
class NestedMachine {
 public:
  explicit NestedMachine(const NestedDescription& description, bool parent_active)
      : description_(description), active_(parent_active), current_(parent_active ? description.initial : 0) {
    TAKT_CHECK(is_sound(description), "a nested machine joins what there is");
  }

  const NestedDescription& description() const { return description_; }
  bool active() const { return active_; }
  /// The status of its CurrentState and LastTransition: Bad_StateNotActive while the parent state is not active.
  StatusCode status() const { return active_ ? StatusCode::Good : StatusCode::BadStateNotActive; }
  /// The substate; nullptr if there is none.
  const Substate* current() const { return description_.substate(current_); }
  /// The number of the substate, 0 if there is none; nothing while the parent state is not active.
  std::optional<std::uint32_t> current_number() const { return active_ ? std::optional(current_) : std::nullopt; }
  std::uint32_t last_transition() const { return last_transition_; }

  /// Goes to a substate, or to none with 0. Gives the transition taken; nullptr, and nothing changes, if there is none.
  const Subtransition* go(std::uint32_t number) {
    if (!active_) return nullptr;
    const Subtransition* const transition = description_.between(current_, number);
    if (transition != nullptr) {
      current_ = number;
      last_transition_ = transition->number;
    }
    return transition;
  }
  /// The parent state was entered: the initial substate with it. Gives the transition into it, if there is one.
  const Subtransition* activate() {
    active_ = true;
    current_ = 0;
    last_transition_ = 0;
    if (description_.initial == 0) return nullptr;
    const Subtransition* const transition = description_.between(0, description_.initial);
    current_ = description_.initial;
    if (transition != nullptr) last_transition_ = transition->number;
    return transition;
  }
  /// The parent state was left. Gives the transition out of the substate, if there was one.
  const Subtransition* deactivate() {
    const Subtransition* const transition = current_ == 0 ? nullptr : description_.between(current_, 0);
    active_ = false;
    current_ = 0;
    last_transition_ = 0;
    return transition;
  }

 private:
  NestedDescription description_;
  bool active_;
  std::uint32_t current_;
  std::uint32_t last_transition_ = 0;
};

}  // namespace takt::program
