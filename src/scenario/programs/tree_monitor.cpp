#include "scenario/programs/tree_monitor.hpp"

namespace takt::scenario {

void TreeMonitor::on_step(std::size_t group, std::size_t participant, const handshake::Outputs& outputs, const handshake::Word& after, const handshake::Origin& origin) {
  observer_.on_step(group, participant, outputs, after);
  reactions_.on_step(observer_.number_of(group, participant), outputs, simulation_->now(), origin);
  const auto all = observer_.violations();
  for (; seen_ < all.size(); ++seen_)
    if (all[seen_].of_tree) violations_.push_back({simulation_->now(), all[seen_]});
}

void TreeMonitor::on_crash(std::size_t group, std::size_t participant) {
  observer_.on_restart(group, participant);
  reactions_.on_crash(observer_.number_of(group, participant), simulation_->now());
}

void TreeMonitor::on_back(std::size_t group, std::size_t participant) { reactions_.on_restart(observer_.number_of(group, participant), simulation_->now()); }

std::pair<std::uint32_t, std::uint8_t> TreeMonitor::initiator_of(const handshake::Reaction& reaction) const {
  std::size_t group = observer_.groups().size() - 1;
  while (observer_.number_of(group, 0) > reaction.initiator) --group;
  return {programs_[group], static_cast<std::uint8_t>(reaction.initiator - observer_.number_of(group, 0))};
}

}  // namespace takt::scenario
