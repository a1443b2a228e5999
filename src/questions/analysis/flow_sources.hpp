// SPDX-License-Identifier: Apache-2.0
// What talkers, Programs and gPTP hand to the egress queues of their nodes: arrival curves, and the time from
// production to the queue.
#pragma once

#include "analysis/flow_graph.hpp"

namespace takt::analysis {

/// Adds a flow without hops for every source of frames: talkers, those that babble, participants of Programs.
void add_flows(const scenario::Resolved& resolved, const BoundOptions& options, const HostTimes& hosts,
               FlowGraph& graph);

/// gPTP at one port: a flow of frames that end at the next node. Nothing if the node of the port does not speak gPTP.
struct GptpMessages {
  FrameArrivals arrivals;
  sim::Octets frame{0};
};
std::vector<GptpMessages> gptp_messages(const scenario::Resolved& resolved, models::NodeIndex node);

}  // namespace takt::analysis
