// SPDX-License-Identifier: Apache-2.0
#include "scenario/programs/tree_monitor.hpp"

namespace takt::scenario {

void TreeMonitor::on_step(std::size_t group, std::size_t participant, const handshake::Outputs& outputs,
                          const handshake::Word& after, const handshake::Origin& origin) {
  const std::size_t number = observer_.tree().number_of(group, participant);
  observer_.on_step(number, outputs, after);
  reactions_.on_step(number, outputs, simulation_->now(), origin);
  const auto all = observer_.violations();
  for (; seen_ < all.size(); ++seen_)
    if (all[seen_].of_tree) violations_.push_back({simulation_->now(), all[seen_]});
}

void TreeMonitor::on_crash(std::size_t group, std::size_t participant) {
  const std::size_t number = observer_.tree().number_of(group, participant);
  observer_.on_restart(number);
  reactions_.on_crash(number, simulation_->now());
}

void TreeMonitor::on_gone(std::size_t group, std::size_t participant) {
  const std::size_t number = observer_.tree().number_of(group, participant);
  observer_.on_restart(number);
  reactions_.on_leave(number, simulation_->now());
}

void TreeMonitor::on_back(std::size_t group, std::size_t participant) {
  reactions_.on_restart(observer_.tree().number_of(group, participant), simulation_->now());
}

std::pair<std::uint32_t, std::uint8_t> TreeMonitor::initiator_of(const handshake::Reaction& reaction) const {
  const handshake::GroupTree& tree = observer_.tree();
  return {programs_[tree.group_of(reaction.initiator)], static_cast<std::uint8_t>(tree.index_of(reaction.initiator))};
}

}  // namespace takt::scenario
