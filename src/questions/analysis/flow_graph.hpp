// SPDX-License-Identifier: Apache-2.0
// The frames of a scenario as a graph of hops: which flows come to which egress port, from where, with what frames.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "analysis/bounds.hpp"
#include "analysis/host_times.hpp"
#include "analysis/port_bound.hpp"

namespace takt::analysis {

/// One direction of a link.
struct GraphPort {
  models::NodeIndex node;
  std::uint16_t number = 0;
  models::NodeIndex peer;
  Ps octet_time = 0;
  Ps propagation = 0;
  std::uint32_t link = 0;           ///< in plan.links
  bool from_a = true;               ///< to the link's other end
  std::uint32_t config = 0;         ///< in plan.port_configs
  bool may_double = false;          ///< chance doubles frames on the link
  std::vector<std::uint32_t> hops;  ///< that pass it
};

/// How ATS holds a flow back before a hop.
struct AtsHold {
  bool is_minded =
      true;  ///< the class is sent by eligibility times; if not, the flow only moves on the times of its group
  bool is_shared = false;       ///< several flows, or several members of one, take the tokens of the scheduler
  std::uint64_t scheduler = 0;  ///< hops with the same number have the same scheduler
  std::uint64_t group = 0;      ///< flows with the same number share a scheduler group, and wait for each other
  ArrivalPattern shaped;        ///< what leaves the scheduler
  std::int64_t bits = 0;        ///< of a frame, as the scheduler counts them
  std::int64_t burst_bits = 0;
  std::int64_t rate = 0;  ///< bit/s
  Ps longest_residence = unbounded_ps;
};

/// A token bucket that drops what it has no tokens for.
struct TokenMeter {
  std::int64_t burst_bits = 0;
  std::int64_t rate = 0;  ///< bit/s
};

/// What polices a flow on its way to a port.
struct Policing {
  bool is_there = false;
  bool always_may_drop =
      false;  ///< a gate that is closed at times, a maximum that frames exceed, a meter of several streams
  std::optional<TokenMeter> meter;
  std::uint64_t number = 0;  ///< hops with the same number have the same meter
};

/// A flow at one egress port.
struct Hop {
  std::uint32_t flow = 0;
  std::uint32_t port = 0;
  std::vector<std::uint32_t> parents;  ///< hops; none at the talker, several where copies are merged
  std::vector<std::uint32_t> children;
  sim::Octets frame{0};     ///< the longest one
  sim::Octets shortest{0};  ///< of a trace another one
  models::TrafficClass lowest_class = 0;
  models::TrafficClass highest_class = 0;
  bool uses_cqf = false;        ///< the stream gate of cyclic queuing and forwarding gives it its class here
  bool is_copied_here = false;  ///< the node makes several frames of one: its link does not limit them
  Ps beyond = 0;  ///< further cables behind that of the hop before, which relays of stations that are down join to it
  bool headers_come_first = false;  ///< the node may see the frame before its last bit
  std::optional<AtsHold> ats;
  std::optional<ArrivalPattern> metered;  ///< what a flow meter lets pass
  Policing policing;
  sim::Octets msdu{0};      ///< of a frame, with its R-TAG
  std::string unsupported;  ///< why the hop cannot be bounded
};

/// Frames of one stream from one source.
struct Flow {
  models::StreamIndex stream;                 ///< none: gPTP at one port
  FrameArrivals source;                       ///< at the egress queue of the talker
  FrameArrivals at_stack = {};                ///< at the thread of its processor that sends them, if there is one
  FrameArrivals sealing = {};                 ///< at the thread that seals them, if one does
  std::optional<ArrivalPhase> produced = {};  ///< when frames are produced, if that is known
  Ps worst_source = 0;                        ///< from production to the egress queue
  Ps best_source = 0;
  std::optional<std::uint32_t> train = {};  ///< flows with the same number are handed to the port one behind the other,
                                            ///< in the order of the graph's flows
  std::string source_reason = {};           ///< why worst_source is unbounded
  bool may_miss_launch = false;             ///< the operating system may hand a frame over after its launch time
  FrameArrivals handed_over =
      {};        ///< if it is timed: as frames come to the interface, where they wait for their times ...
  Ps waits = 0;  ///< ... for so long
  std::string hold_reason = {};  ///< why its ATS scheduler at the talker may hold it for ever; empty: it does not
  bool is_timed = false;         ///< its frames have launch times, or eligibility times of a scheduler at the talker
  std::optional<sim::Octets> payload =
      {};  ///< of its longest frame, where the stream has longer ones; of the shortest nothing is known then
  std::string unlimited_reason =
      {};  ///< why any number of frames may come at any time, as a clause about the stream: "whose ..."
  std::vector<std::uint32_t> hops;  ///< parents before children
  /// The last hop to each listener, as in the plan; several where the listener takes out copies itself.
  std::vector<std::vector<std::uint32_t>> last;
  bool comes_back = false;             ///< copies of a ladder come back to relays, which must know them
  std::map<std::uint32_t, Ps> beyond;  ///< of a last hop: such cables between it and the listener, at most
  /// Why the ingress of a listener that is a station may drop frames that are for its host; empty: it does not.
  std::string loss_at_host = {};
};

struct FlowGraph {
  std::vector<GraphPort> ports;
  std::vector<Flow> flows;
  std::vector<Hop> hops;
  std::vector<PortModel> models;  ///< by port
  Assumptions assumptions;        ///< that all bounds need
  std::vector<std::string> uncertain_paths =
      {};  ///< streams that rerouting may send in circles, or on too many ways: no bound of anything holds then
};

/// Flows and hops; see flow_sources.hpp and flow_routes.hpp for the parts.
FlowGraph make_flow_graph(const scenario::Resolved& resolved, const BoundOptions& options, const HostTimes& hosts);

/// How good a node's clock is under the scenario's clocks.
ClockQuality clock_quality(const scenario::Resolved& resolved, models::NodeIndex node, const BoundOptions& options);

}  // namespace takt::analysis
