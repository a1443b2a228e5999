#include "models/bridge/bridge.hpp"

namespace takt::models {

void Bridge::handle(sim::Simulation& simulation, const sim::Event& event) {
  TAKT_CHECK(event.kind() == static_cast<sim::EventKind>(NodeEvent::frame_arrived), "a bridge receives frames only");
  const ArrivalArgument arrival = ArrivalArgument::unpack(event.argument);
  if (chain_ != nullptr && !chain_->pass(simulation, arrival.frame, arrival.port)) return;
  const Frame& frame = traffic_->frame(arrival.frame);
  const std::span<const std::uint16_t> egress = filtering_database_.find(frame.vlan, frame.destination);
  if (egress.size() == 1 && egress[0] != arrival.port) [[likely]] {
    ports_[egress[0]].offer(simulation, arrival.frame, arrival.port);
    return;
  }
  forward_to_many(simulation, arrival, egress);
}

void Bridge::forward_to_many(sim::Simulation& simulation, ArrivalArgument arrival, std::span<const std::uint16_t> egress) {
  bool used = false;
  for (const std::uint16_t port : egress) {
    TAKT_CHECK(port < port_count_, "a filtering entry names a port of its bridge");
    if (port == arrival.port) continue;
    if (used) traffic_->copy(arrival.frame);
    used = true;
    ports_[port].offer(simulation, arrival.frame, arrival.port);
  }
  if (!used) traffic_->drop(arrival.frame, DropReason::no_filtering_entry, id_, simulation);
}

}  // namespace takt::models
