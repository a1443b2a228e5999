// SPDX-License-Identifier: Apache-2.0
#include "scenario/programs/role_monitor.hpp"

namespace takt::scenario {
namespace {
constexpr std::uint32_t role_bound = 104;  // kind of digest record; see program_monitor.cpp
}

void RoleMonitor::judge_binding(std::size_t role, const handshake::Binding& binding) {
  const handshake::RoleObserver::Change change = observers_[role].on_bound(binding, state_of_(binding));
  if (!change.is_new) return;
  if (change.gone) program_->judge(observed::Gone{role + 1, *change.gone});
  if (binding.bound()) program_->judge(observed::Back{role + 1, nodes_[binding.candidate]});
  simulation_->digest().add(role_bound, static_cast<std::uint64_t>(number_) << 32 | role, simulation_->now(),
                            static_cast<std::uint64_t>(binding.candidate) << 32 | binding.life);
  if (!change.is_another || history_.size() >= most_records) return;
  history_.push_back({simulation_->now(), static_cast<std::uint8_t>(role),
                      binding.bound() ? std::optional(binding.candidate) : std::nullopt});
}

void RoleMonitor::on_step(std::size_t role, const handshake::Binding& self, const handshake::Outputs& outputs,
                          const handshake::Word& after) {
  if (observers_[role].on_step(self, after.state)) program_->on_step(role + 1, outputs, after);
}

void RoleMonitor::on_dropped(std::size_t role, const handshake::Binding& self, bool has_crashed) {
  const auto before = observers_[role].on_dropped(self);
  if (before) has_crashed ? program_->on_crash(role + 1, *before) : program_->on_gone(role + 1, *before);
}

void RoleMonitor::on_process_data(std::size_t role, const handshake::Binding& self, std::size_t from,
                                  std::uint32_t sent_in) {
  if (observers_[role].counts(self)) program_->on_process_data(from, role + 1, sent_in);
}

bool RoleMonitor::has_role(std::uint8_t candidate) const {
  for (std::size_t role = 0; role < observers_.size(); ++role)
    if (binding(role).bound() && binding(role).candidate == candidate) return true;
  return false;
}

}  // namespace takt::scenario
