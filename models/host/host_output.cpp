#include "models/host/host_output.hpp"

namespace takt::models {

void HostOutput::offer(sim::Simulation& simulation, FrameIndex frame, std::uint32_t rank, sim::LocalTime local_now) {
  Frame& record = traffic_->frame(frame);
  if (!up_ || (record.marked && record.eligible < local_now)) {
    traffic_->drop(frame, up_ ? DropReason::late_launch : DropReason::node_down, port().id(), simulation);
    return;
  }
  if (!ats_.is_empty()) ats_.shape(record, local_now);   // before the members part: what is shaped is the stream, once
  const std::span<const TalkerRedundancy::Outgoing> members = redundancy_.is_empty() ? std::span<const TalkerRedundancy::Outgoing>() : redundancy_.send(*traffic_, frame);
  if (members.empty()) {
    if (bridge_ != nullptr)
      bridge_->send(simulation, frame, rank);
    else
      port().offer(simulation, frame, rank);
    return;
  }
  for (const TalkerRedundancy::Outgoing& outgoing : members) {
    TAKT_CHECK(outgoing.port < ports_.size(), "a member stream leaves by an interface that exists");
    if (bridge_ != nullptr)
      bridge_->send(simulation, outgoing.frame, rank);   // members have entries of their own
    else
      ports_[outgoing.port].offer(simulation, outgoing.frame, rank);
  }
}

}  // namespace takt::models
