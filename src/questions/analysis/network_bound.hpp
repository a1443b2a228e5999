// SPDX-License-Identifier: Apache-2.0
// The fixed point over all ports: how late each flow can come to each hop, given what the hops before do to all others.
//
// Total-flow analysis with exact staircases: a flow that may come between `best` and `worst` after its production comes
// to a hop with its source's arrival curve and worst - best more jitter. Delays follow from arrivals, arrivals from
// delays; from no jitter at all upwards, until nothing changes. Where paths depend on each other in circles the fixed
// point is a bound too, if there is one; what grows without end is unbounded.
#pragma once

#include <functional>

#include "analysis/flow_graph.hpp"

namespace takt::analysis {

/// A frame that the port before sends by cyclic queuing and forwarding.
struct CyclicArrival {
  CyclicFrames comes;  ///< to this port
  Ps best = 0;         ///< from production to the start of the cycle in which it was sent
  Ps worst = 0;
  bool operator==(const CyclicArrival&) const = default;
};

struct HopResult {
  Ps best = 0;  ///< from production to the arrival at the port
  Ps worst = 0;
  Ps delay = 0;  ///< at the port
  Ps least_delay = 0;
  Ps best_left = 0;  ///< from production to the last bit on the wire; not just the sum, where a schedule of gates holds
  Ps worst_left = 0;
  std::optional<ArrivalPhase> phase;    ///< when frames come to the port, if that is known
  std::optional<ArrivalPhase> leaves;   ///< when their last bits leave it, where a schedule of gates says it
  std::optional<CyclicArrival> cyclic;  ///< if the port before has cycles
  std::optional<SendingCycle> cycle;    ///< if this one has
  bool is_never_held = false;           ///< an ATS scheduler is there, but all of its group keep to their buckets
  bool may_drop = false;                ///< what polices the flow before this port may drop its frames
  std::string reason;                   ///< why `worst` is unbounded, if this hop is where it begins
};

struct NetworkResult {
  std::vector<HopResult> hops;
  std::vector<FrameArrivals> arrivals;  ///< by hop, at the port
  std::vector<PortBound> ports;         ///< of the last round
  int rounds = 0;
  std::uint64_t port_analyses = 0;
  bool is_interrupted = false;  ///< nothing of the rest counts
};

/// `interrupted`: asked before each port is looked at; true ends it.
NetworkResult bound_network(const scenario::Resolved& resolved, const FlowGraph& graph,
                            const std::function<bool()>& interrupted = {});

}  // namespace takt::analysis
