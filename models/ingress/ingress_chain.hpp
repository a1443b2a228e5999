// What a frame passes between the medium and the filtering database: the seam for stream identification, individual
// recovery, stream filters, stream gates, meters and ATS schedulers (IEEE 802.1Q clause 8.6.5, IEEE 802.1CB clause 8).
#pragma once

#include <cstdint>

#include "models/ethernet/traffic.hpp"
#include "sim/simulation.hpp"

namespace takt::models {

/// A port without a chain costs one predictable branch. A chain decides at the instant at which the node takes the frame.
class IngressChain {
 public:
  virtual ~IngressChain() = default;
  /// True if the frame goes on (possibly with another priority); false if the chain has taken it out and accounted for it.
  virtual bool pass(sim::Simulation& simulation, FrameIndex frame, std::uint16_t port) = 0;
};

}  // namespace takt::models
