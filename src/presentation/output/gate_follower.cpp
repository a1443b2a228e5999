// SPDX-License-Identifier: Apache-2.0
#include "output/gate_follower.hpp"

#include <utility>

namespace takt::output {

GateFollower::GateFollower(const models::Network& network, const models::PortDirectory& directory, sim::TrueTime now)
    : network_(&network), directory_(&directory), gates_(directory.ports().size()) {
  for (std::uint32_t position = 0; position < gates_.size(); ++position) look_at(position, now);
}

const models::EgressPort& GateFollower::live(std::uint32_t position) const {
  const models::PortId id = directory_->ports()[position].id;
  return network_->ports(id.node)[id.port];
}

bool GateFollower::has_gates(std::uint32_t position) const {
  return network_->has(directory_->ports()[position].id.node) && live(position).shaping() != nullptr &&
         live(position).shaping()->has_gates();
}

void GateFollower::look_at(std::uint32_t position, sim::TrueTime now) {
  if (!has_gates(position)) return;
  Gates& followed = gates_[position];
  followed.is_there = true;
  followed.schedule = std::as_const(*live(position).shaping()).gates();
  followed.stuck_open = live(position).shaping()->with_forced(0);
  followed.not_stuck_closed = live(position).shaping()->with_forced(0xFF);
  followed.next = now;
  follow(position);
}

/// Notes when they next change.
void GateFollower::follow(std::uint32_t position) {
  const models::LocalClock& clock = live(position).clock();
  Gates& followed = gates_[position];
  const sim::LocalTime change = followed.schedule.next_change(clock.local_at(followed.next));
  // A clock that was changed meanwhile may place it before what was shown already: the way is forwards in any case.
  followed.next = change == sim::LocalTime::never() ? sim::TrueTime::never() : clock.true_after(change, followed.next);
  if (followed.next != sim::TrueTime::never()) changes_.push({followed.next, position});
}

std::uint64_t GateFollower::states(std::uint32_t position, sim::TrueTime at) {
  Gates& followed = gates_[position];
  if (!followed.is_there) return 0xFF;
  const std::uint64_t states = followed.schedule.gate_states(live(position).clock().local_at(at));
  return (states & followed.not_stuck_closed) | followed.stuck_open;
}

sim::TrueTime GateFollower::next_time() {
  while (!changes_.empty() && gates_[changes_.top().position].next != changes_.top().time) changes_.pop();
  return changes_.empty() ? sim::TrueTime::never() : changes_.top().time;
}

GateFollower::Change GateFollower::pop() {
  const Change change = changes_.top();
  changes_.pop();
  follow(change.position);
  return change;
}

}  // namespace takt::output
