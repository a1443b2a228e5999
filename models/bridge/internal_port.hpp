// SPDX-License-Identifier: Apache-2.0
// The port of a bridge without a cable: it leads to the host that shares its station.
#pragma once

#include <cstdint>

#include "models/ethernet/frame.hpp"
#include "sim/simulation.hpp"

namespace takt::models {

/// In filtering entries: the host of the station. No other port has this number.
constexpr std::uint16_t internal_port = 0x7FFF;

/// Frames that meet at an instant at a port go by rank: those that come by the medium have the number of their port,
/// those that the node sends itself come behind them.
constexpr std::uint32_t rank_of_own(std::uint32_t sender) { return 0x1'0000 + sender; }

/// Takes what a bridge forwards to its internal port.
class InternalReceiver {
 public:
  virtual ~InternalReceiver() = default;
  /// The frame, which came through `port` of the bridge, is wholly in and the forwarding delay is over.
  virtual void receive_internally(sim::Simulation& simulation, FrameIndex frame, std::uint16_t port) = 0;
};

}  // namespace takt::models
