// SPDX-License-Identifier: Apache-2.0
// What a frame passes between the medium and the filtering database: the seam for stream identification, individual
// recovery, stream filters, stream gates, meters and ATS schedulers (IEEE 802.1Q clause 8.6.5, IEEE 802.1CB clause 8).
#pragma once

#include <cstdint>
#include <span>

#include "models/ethernet/traffic.hpp"
#include "sim/simulation.hpp"

namespace takt::models {

/// A frame that a node has taken from the medium.
struct Ingress {
  FrameIndex frame;
  std::uint16_t port = 0;  ///< of the node
  /// When its last bit was in (where it is cut through: when its header was). The fixed forwarding delay comes after
  /// that, so this lies before the simulation's present instant by as much. Does not decrease from call to call for one
  /// port.
  sim::TrueTime on_wire;
};

/// A bridge without a chain spends one predictable branch on it.
class IngressChain {
 public:
  virtual ~IngressChain() = default;
  /// The frames that go on: none if the chain has taken the frame out (and accounted for it, see Traffic::drop), one,
  /// or several where a stream is split. A chain that changes a frame first makes the record its own (Traffic::own);
  /// queue_priority and eligible are set together with `marked`. The frame comes unmarked, with queue_priority ==
  /// priority. The span lives until the next call.
  virtual std::span<const FrameIndex> pass(sim::Simulation& simulation, Ingress ingress) = 0;
  /// The short way of most frames. True: the frame has passed in the record that it has, in which it may have been
  /// marked. False: nothing has happened, and pass() follows.
  virtual bool passes_as_it_is(Frame& frame, std::uint16_t port, sim::TrueTime on_wire) = 0;
};

}  // namespace takt::models
