// SPDX-License-Identifier: Apache-2.0
// Whether a copy of each frame of a redundant stream comes to each listener, whatever the scenario's faults take away.
#pragma once

#include <functional>
#include <string>

#include "analysis/bounds.hpp"
#include "analysis/flow_graph.hpp"
#include "analysis/outages.hpp"

namespace takt::analysis {

/// What loses frames at a hop although nothing has failed, and chance on its link; empty: nothing does.
using LossAtHop = std::function<std::string(const Hop&)>;

/// A copy is lost if something on its way is down at any time while it may be under way; a frame, if all are. And the
/// recovery must take the copies of whichever way is left for what comes next: it discards what is further ahead than
/// its history (IEEE 802.1CB 7.4.3.4). Empty if a copy of each frame comes to each listener; otherwise the reason.
/// `bound` has the latencies.
std::string why_copies_may_be_lost(const scenario::Resolved& resolved, const FlowGraph& graph, const Flow& flow,
                                   const scenario::ResolvedRedundancy& redundancy, const StreamBound& bound,
                                   const Outages& outages, const LossAtHop& loss_at);

}  // namespace takt::analysis
