// SPDX-License-Identifier: Apache-2.0
// Separated-flow analysis of a scenario, a second opinion on latencies: what each port leaves to a flow beside all
// others, composed along its path, so that the flow pays for its own burst once.
//
// Ports with strict priority and FIFO queues only. Service of a class with rate C, blocked by a frame B, behind higher
// classes with token buckets (r, b): rate R = C - sum of r after (B + sum of b) / R. To the flow in its class it leaves
// R - r' after T + b' / R, r' and b' of the others there (left_over_fifo of curve.hpp). A frame is stored at each hop:
// one frame more of latency, but at the last (Le Boudec, Thiran: Network Calculus, 1.7 and 6.4). The buckets of others
// are those with which the total-flow analysis lets them come.
#pragma once

#include <string>

#include "analysis/flow_graph.hpp"
#include "analysis/network_bound.hpp"

namespace takt::analysis {

/// From production to the last bit at the listener's end of the link; the reason if that is not bounded.
struct SeparatedFlowBound {
  Ps latency = unbounded_ps;
  std::string reason;
};

class SeparatedFlows {
 public:
  SeparatedFlows(const scenario::Resolved& resolved, const FlowGraph& graph, const NetworkResult& network)
      : r_(resolved), graph_(graph), network_(network) {}

  /// Of the flow whose last hop that is.
  SeparatedFlowBound bound(std::uint32_t last) const;

 private:
  struct Service;
  std::string objection(const Hop& hop) const;
  Service left_over(std::uint32_t h) const;

  const scenario::Resolved& r_;
  const FlowGraph& graph_;
  const NetworkResult& network_;
};

}  // namespace takt::analysis
