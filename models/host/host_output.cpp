// SPDX-License-Identifier: Apache-2.0
#include "models/host/host_output.hpp"

#include <array>

namespace takt::models {

/// False: it has been dropped.
inline bool HostOutput::accepts(sim::Simulation& simulation, FrameIndex frame, sim::LocalTime local_now) {
  Frame& record = traffic_->frame(frame);
  if (!up_ || (record.marked && record.eligible < local_now)) {
    traffic_->drop(frame, up_ ? DropReason::late_launch : DropReason::node_down, port().id(), simulation);
    return false;
  }
  if (!ats_.is_empty()) ats_.shape(record, local_now);  // before the members part: what is shaped is the stream, once
  return true;
}

inline void HostOutput::hand_over(sim::Simulation& simulation, FrameIndex frame, std::uint32_t rank) {
  if (bridge_ != nullptr)
    bridge_->send(simulation, frame, rank);
  else
    port().offer(simulation, frame, rank);
}

void HostOutput::hand_over(sim::Simulation& simulation, std::span<const TalkerRedundancy::Outgoing> members,
                           std::uint32_t rank) {
  for (const TalkerRedundancy::Outgoing& outgoing : members) {
    TAKT_CHECK(outgoing.port < ports_.size(), "a member stream leaves by an interface that exists");
    if (bridge_ != nullptr)
      bridge_->send(simulation, outgoing.frame, rank);  // members have entries of their own
    else
      ports_[outgoing.port].offer(simulation, outgoing.frame, rank);
  }
}

/// Members that leave by different ports do not wait for one another, so each is the only frame that comes to its port
/// at an instant at which nothing else happens. False: some leave by one port, or it is not known at once by which.
bool HostOutput::send_member_streams(sim::Simulation& simulation, std::span<const TalkerRedundancy::Outgoing> members,
                                     std::uint32_t rank) {
  if (bridge_ == nullptr || members.size() > most_apart) return false;
  std::array<std::uint32_t, most_apart> ports;
  std::uint64_t used = 0;
  for (std::size_t i = 0; i < members.size(); ++i) {
    const std::uint32_t port = bridge_->port_of_own(traffic_->frame(members[i].frame));
    if (port >= 64 || (used >> port & 1) != 0) return false;
    used |= std::uint64_t{1} << port;
    ports[i] = port;
  }
  for (std::size_t i = 0; i < members.size(); ++i)
    ports_[ports[i]].offer_last(simulation, members[i].frame, traffic_->frame(members[i].frame), rank_of_own(rank));
  return true;
}

void HostOutput::offer(sim::Simulation& simulation, FrameIndex frame, std::uint32_t rank, sim::LocalTime local_now) {
  if (!accepts(simulation, frame, local_now)) return;
  if (const std::span<const TalkerRedundancy::Outgoing> members = members_of(frame); !members.empty())
    hand_over(simulation, members, rank);
  else
    hand_over(simulation, frame, rank);
}

void HostOutput::offer_last(sim::Simulation& simulation, FrameIndex frame, std::uint32_t rank,
                            sim::LocalTime local_now) {
  if (!accepts(simulation, frame, local_now)) return;
  if (const std::span<const TalkerRedundancy::Outgoing> members = members_of(frame); !members.empty()) {
    if (!simulation.is_last() || !send_member_streams(simulation, members, rank)) hand_over(simulation, members, rank);
  } else {
    hand_over(simulation, frame, rank);
  }
}

}  // namespace takt::models
