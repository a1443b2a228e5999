// The ghost of roles: whose steps are those of a role's participant. It stands before a GroupObserver, and no protocol code asks it.
//
// A participant there is a role, whoever has it. Who has been let go and does not know it yet is nobody's participant; what it does counts
// no more.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "handshake/binder.hpp"

namespace takt::handshake {

class RoleObserver {
 public:
  explicit RoleObserver(std::size_t roles) : roles_(roles) {}

  struct Change {
    /// In this state the former participant of the role has ceased to be; nothing: there was none that did anything.
    std::optional<PublishedState> gone;
    bool is_another = false;  ///< another node than before, or none
    bool is_new = false;      ///< another life of a node; without it nothing has changed
  };
  /// The master has bound a role. `before`: the state in which the participant of that life is already, if there is one.
  Change on_bound(std::size_t role, const Binding& binding, std::optional<PublishedState> before);
  /// The participant of a life has taken a step in a role, and is in this state now. True if it is the role's step.
  bool on_step(std::size_t role, const Binding& self, PublishedState after);
  /// A participant is gone: it was let go, or its node has crashed. Its state, if it was the role's participant.
  std::optional<PublishedState> on_dropped(std::size_t role, const Binding& self);
  /// Whether what this life hears and says is the role's.
  bool counts(std::size_t role, const Binding& self) const { return roles_[role].binding == self && !roles_[role].is_awaited; }

  std::size_t roles() const { return roles_.size(); }
  PublishedState state(std::size_t role) const { return roles_[role].state; }
  const Binding& binding(std::size_t role) const { return roles_[role].binding; }

 private:
  struct Role {
    Binding binding;
    bool is_awaited = false;  ///< a restarted master has bound a life that is still in a former run: seen from when it is Halted on
    PublishedState state = PublishedState::Halted;
  };
  std::vector<Role> roles_;
};

}  // namespace takt::handshake
