#include "scenario/programs/plug_monitor.hpp"

namespace takt::scenario {
namespace {
constexpr std::uint32_t role_bound = 104;  // kind of digest record; see program_monitor.cpp
}

void PlugMonitor::on_bound(std::size_t role, const handshake::Binding& binding, std::optional<handshake::PublishedState> before) {
  Role& each = roles_[role];
  if (each.binding == binding) return;
  if (each.state != handshake::PublishedState::Halted || each.binding.bound()) program_->on_crash(role + 1, each.state);
  const bool is_another = each.binding.candidate != binding.candidate;
  each.binding = binding;
  each.state = handshake::PublishedState::Halted;
  each.is_awaited = before && *before != handshake::PublishedState::Halted;
  simulation_->digest().add(role_bound, static_cast<std::uint64_t>(number_) << 32 | role, simulation_->now(),
                            static_cast<std::uint64_t>(binding.candidate) << 32 | binding.life);
  if (!is_another || history_.size() >= most_records) return;
  history_.push_back({simulation_->now(), static_cast<std::uint8_t>(role), binding.bound() ? std::optional(binding.candidate) : std::nullopt});
}

void PlugMonitor::on_step(std::size_t role, const handshake::Binding& self, const handshake::Outputs& outputs, const handshake::Word& after) {
  Role& each = roles_[role];
  if (each.binding != self) return;
  if (each.is_awaited) {
    each.is_awaited = after.state != handshake::PublishedState::Halted;
    return;
  }
  each.state = after.state;
  program_->on_step(role + 1, outputs, after);
}

void PlugMonitor::on_dropped(std::size_t role, const handshake::Binding& self) {
  Role& each = roles_[role];
  if (each.binding != self) return;
  program_->on_crash(role + 1, each.state);
  each.state = handshake::PublishedState::Halted;
  each.is_awaited = false;
}

void PlugMonitor::on_process_data(std::size_t role, const handshake::Binding& self, std::size_t from, std::uint32_t sent_in) {
  if (roles_[role].binding == self && !roles_[role].is_awaited) program_->on_process_data(from, role + 1, sent_in);
}

}  // namespace takt::scenario
