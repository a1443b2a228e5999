#include "handshake/role_observer.hpp"

namespace takt::handshake {

auto RoleObserver::on_bound(std::size_t role, const Binding& binding, std::optional<PublishedState> before) -> Change {
  Role& each = roles_[role];
  Change change;
  if (each.binding == binding) return change;
  change.is_new = true;
  if (each.state != PublishedState::Halted || each.binding.bound()) change.gone = each.state;
  change.is_another = each.binding.candidate != binding.candidate;
  each = {binding, before && *before != PublishedState::Halted, PublishedState::Halted};
  return change;
}

bool RoleObserver::on_step(std::size_t role, const Binding& self, PublishedState after) {
  Role& each = roles_[role];
  if (each.binding != self) return false;
  if (each.is_awaited) {
    each.is_awaited = after != PublishedState::Halted;
    return false;
  }
  each.state = after;
  return true;
}

std::optional<PublishedState> RoleObserver::on_dropped(std::size_t role, const Binding& self) {
  Role& each = roles_[role];
  if (each.binding != self) return std::nullopt;
  const PublishedState before = each.state;
  each.state = PublishedState::Halted;
  each.is_awaited = false;
  return before;
}

}  // namespace takt::handshake
