// SPDX-License-Identifier: Apache-2.0
// How many frames of a stream may be lost or late one after another, or among any so many.
#pragma once

#include "analysis/flow_graph.hpp"

namespace takt::analysis {

/// Of a limit on misses of frames: the count is the most that are missed in a row or, of "met", among any `of`.
///
/// Late: none where the bound of the latency is within the deadline, and nothing is known otherwise. Lost: none where
/// each frame comes. Where faults alone take frames, those whose lives meet an outage of a link on their way, or the
/// time in which chance loses frames there; outages between which a frame must come are apart.
RequirementBound misses_bound(const scenario::Resolved& resolved, const FlowGraph& graph, const StreamBound& stream,
                              const scenario::RequiredFigure& required);

}  // namespace takt::analysis
