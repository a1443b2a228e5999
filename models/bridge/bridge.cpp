#include "models/bridge/bridge.hpp"

namespace takt::models {

void Bridge::handle(sim::Simulation& simulation, const sim::Event& event) {
  TAKT_CHECK(event.kind() == static_cast<sim::EventKind>(NodeEvent::frame_arrived), "a bridge receives frames only");
  const ArrivalArgument arrival = ArrivalArgument::unpack(event.argument);
  if (chain_ != nullptr && !chain_->pass(simulation, arrival.frame, arrival.port)) return;
  const Frame& frame = traffic_->frame(arrival.frame);
  const FilteringDatabase::Entry entry = filtering_database_.find(frame.vlan, frame.destination);
  if (entry.found() && entry.is_one_port() && entry.port() != arrival.port) [[likely]] {
    ports_[entry.port()].offer_last(simulation, arrival.frame, arrival.port);
    return;
  }
  const std::uint16_t one = entry.port();
  if (!entry.found())
    forward_to_many(simulation, arrival, {});
  else
    forward_to_many(simulation, arrival, entry.is_one_port() ? std::span(&one, 1) : filtering_database_.ports_of(entry));
}

void Bridge::prefetch(const sim::Event& event, Ahead ahead) const {
  const Frame& frame = traffic_->frame(ArrivalArgument::unpack(event.argument).frame);
  if (ahead == Ahead::two_events) {
    filtering_database_.prefetch(frame.vlan, frame.destination);
    return;
  }
  const FilteringDatabase::Entry entry = filtering_database_.find(frame.vlan, frame.destination);
  if (entry.found() && entry.is_one_port()) ports_[entry.port()].prefetch_hot();
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
