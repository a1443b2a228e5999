// SPDX-License-Identifier: Apache-2.0
// The way from the programs of a host to its network interfaces.
#pragma once

#include <cstdint>
#include <span>

#include "models/bridge/bridge.hpp"
#include "models/egress/egress_port.hpp"
#include "models/frer/host_redundancy.hpp"
#include "models/host/talker_ats.hpp"

namespace takt::models {

/// Most hosts have one interface and send each frame unchanged: senders check is_plain() and use port() directly.
class alignas(64) HostOutput {
 public:
  HostOutput(Traffic& traffic, std::span<EgressPort> ports) : traffic_(&traffic), ports_(ports) {
    TAKT_CHECK(!ports.empty(), "a host that sends has a link");
  }

  bool is_plain() const { return plain_; }
  EgressPort& port() const { return ports_[0]; }

  /// The same as offer() as the last act of an event handler: ports decide at once if nothing else happens to the node
  /// at this instant.
  void offer_last(sim::Simulation& simulation, FrameIndex frame, std::uint32_t rank, sim::LocalTime local_now);

  /// Hands a frame to the interfaces that it leaves by, at the present instant. A frame with a launch time that has
  /// passed by `local_now` is dropped, as is every frame of a host that is down.
  void offer(sim::Simulation& simulation, FrameIndex frame, std::uint32_t rank, sim::LocalTime local_now);

  /// The host has several interfaces, or those of a station: who chooses among them. The bridge outlives this.
  void choose_by(Bridge& bridge) {
    bridge_ = &bridge;
    plain_ = false;
  }
  /// A stream of this host is split into member streams (IEEE 802.1CB).
  void split(StreamIndex stream, const StreamSplitConfig& config, sim::ComponentId host) {
    redundancy_.add(stream, config, host);
    plain_ = false;
  }
  /// A stream of this host is shaped by eligibility times; parameters as in TalkerAts::add.
  void shape(StreamIndex stream, sim::DataRate rate, Octets burst, bool counts_overhead) {
    ats_.add(stream, rate, burst, counts_overhead);
    plain_ = false;
  }
  TalkerRedundancy& redundancy() { return redundancy_; }
  /// Some frames carry a launch time, or the host may go down.
  void disable_fast_path() { plain_ = false; }
  void set_up(bool up) { up_ = up; }
  bool is_up() const { return up_; }

 private:
  static constexpr std::size_t most_apart = 8;
  bool accepts(sim::Simulation& simulation, FrameIndex frame, sim::LocalTime local_now);
  std::span<const TalkerRedundancy::Outgoing> members_of(FrameIndex frame) {
    return redundancy_.is_empty() ? std::span<const TalkerRedundancy::Outgoing>() : redundancy_.send(*traffic_, frame);
  }
  void hand_over(sim::Simulation& simulation, FrameIndex frame, std::uint32_t rank);
  void hand_over(sim::Simulation& simulation, std::span<const TalkerRedundancy::Outgoing> members, std::uint32_t rank);
  bool send_member_streams(sim::Simulation& simulation, std::span<const TalkerRedundancy::Outgoing> members,
                           std::uint32_t rank);

  Traffic* traffic_;
  std::span<EgressPort> ports_;
  Bridge* bridge_ = nullptr;
  bool plain_ = true;
  bool up_ = true;
  TalkerRedundancy redundancy_;
  TalkerAts ats_;
};

}  // namespace takt::models
