// SPDX-License-Identifier: Apache-2.0
// The observer of a role: whose steps are those of the role's participant. It stands before an observer of the group,
// and no protocol code asks it.
//
// A participant there is a role, whoever has it. Who has been let go and does not know it yet is nobody's participant;
// what it does counts no more.
#pragma once

#include <optional>
#include <utility>

#include "handshake/binder.hpp"

namespace takt::handshake {

/// Of one role; a small value.
class RoleObserver {
 public:
  struct Change {
    /// In this state the former participant of the role has ceased to be; nothing: there was none that did anything.
    std::optional<PublishedState> gone;
    bool is_another = false;  ///< another node than before, or none
    bool is_new = false;      ///< another life of a node; without it nothing has changed
  };
  /// The master has bound the role. `before`: the state in which the participant of that life is already, if there is
  /// one.
  Change on_bound(const Binding& binding, std::optional<PublishedState> before) {
    Change change;
    if (binding_ == binding) return change;
    change.is_new = true;
    if (state_ != PublishedState::Halted || binding_.bound()) change.gone = state_;
    change.is_another = binding_.candidate != binding.candidate;
    binding_ = binding;
    is_awaited_ = before.value_or(PublishedState::Halted) != PublishedState::Halted;
    state_ = PublishedState::Halted;
    return change;
  }
  /// The participant of a life has taken a step in the role, and is in this state now. True if it is the role's step.
  bool on_step(const Binding& self, PublishedState after) {
    if (binding_ != self) return false;
    if (is_awaited_) {
      is_awaited_ = after != PublishedState::Halted;
      return false;
    }
    state_ = after;
    return true;
  }
  /// A participant is gone: it was let go, or its node has crashed. Its state, if it was the role's participant.
  std::optional<PublishedState> on_dropped(const Binding& self) {
    if (binding_ != self) return std::nullopt;
    is_awaited_ = false;
    return std::exchange(state_, PublishedState::Halted);
  }

  /// Whether what this life hears and says is the role's.
  bool counts(const Binding& self) const { return binding_ == self && !is_awaited_; }
  PublishedState state() const { return state_; }
  const Binding& binding() const { return binding_; }
  bool is_awaited() const { return is_awaited_; }
  bool operator==(const RoleObserver&) const = default;

 private:
  Binding binding_;
  bool is_awaited_ =
      false;  ///< a restarted master has bound a life that is still in a former run: seen from when it is Halted on
  PublishedState state_ = PublishedState::Halted;
};

}  // namespace takt::handshake
