// SPDX-License-Identifier: Apache-2.0
// Textbook network calculus: flows with token buckets through rate-latency servers, total-flow and separated-flow
// analysis.
//
// Conventions, which decide the numbers:
// - Servers know no packets. A delay is from the arrival of a bit to its departure.
// - TFA, FIFO: the delay at a server is the horizontal deviation of the sum of all flows, latency + sum of bursts /
// rate; that of a flow is the sum over its
//   path. Under arbitrary multiplexing it is the longest busy period, unless the flow is alone.
// - SFA: at each server the flow gets what the others leave (left_over_fifo, left_over_arbitrary); these curves are
// convolved into one.
// - A flow arrives at a server as it left the last one: all flows that come by one link are bounded together. Where
// their paths have been the same, back to where
//   they joined, they pass each server as one flow, against what the others there leave, so their bursts grow by rate *
//   left-over latency at each. In SFA the analysed flow itself is no cross traffic to those that have come along with
//   it; where paths part and meet again it is, and with FIFO also where others come and go along its path in turns
//   (docs/bounds.md has the proof).
// See "Total flow analysis" and "Separated flow analysis" in Le Boudec, Thiran: Network Calculus (2001), and Schmitt,
// Zdarsky: The DISCO network calculator (2006), whose order of steps these are.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "analysis/curve.hpp"

namespace takt::analysis {

enum class Multiplexing : std::uint8_t { fifo, arbitrary };

struct Server {
  std::string name;
  RateLatency service;
};

struct ServerFlow {
  std::string name;
  TokenBucket arrival;
  std::vector<std::size_t> path;  ///< servers, in order, each at most once; at least one
};

struct ServerNetwork {
  std::vector<Server> servers;
  std::vector<ServerFlow> flows;
  Multiplexing multiplexing = Multiplexing::fifo;
  /// No flow's path leads, by way of others', back to a server. Both analyses ask for it.
  bool is_feed_forward() const;
};

/// Bounds of a flow at one server of its path.
struct ServerBound {
  std::optional<Rational> delay;    ///< TFA only
  std::optional<Rational> backlog;  ///< of the whole server
};

/// Bounds of a flow; nothing where there is none.
struct FlowBound {
  std::optional<Rational> delay;
  std::optional<Rational>
      backlog;  ///< TFA: the greatest at a server of the path; SFA: of the flow itself, in all servers
  std::vector<ServerBound> servers;    ///< TFA: by hop
  std::optional<RateLatency> service;  ///< SFA: what the flow gets from end to end
};

/// By flow. Precondition: network.is_feed_forward(). Throws RationalOverflow.
std::vector<FlowBound> total_flow_analysis(const ServerNetwork& network);
std::vector<FlowBound> separated_flow_analysis(const ServerNetwork& network);

}  // namespace takt::analysis
