// SPDX-License-Identifier: Apache-2.0
// The way of each flow: hops, what switches do to it before their egress ports (stream gates, meters, ATS, CQF, FRER).
#pragma once

#include "analysis/flow_graph.hpp"

namespace takt::analysis {

/// Adds hops to the flows of the graph, along the paths that were laid for their streams.
void add_routes(const scenario::Resolved& resolved, FlowGraph& graph);

}  // namespace takt::analysis
