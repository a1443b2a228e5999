// SPDX-License-Identifier: Apache-2.0
// Frames that several ports send by cyclic queuing and forwarding, one after the other: in which cycle each of them
// does.
#pragma once

#include <optional>
#include <vector>

#include "analysis/network_bound.hpp"

namespace takt::analysis {

/// What the port before hop `h` sends in cycles, as it comes to the port of `h`; nothing if it has none, or if frames
/// may come otherwise.
std::optional<CyclicArrival> cyclic_arrival(const scenario::Resolved& resolved, const FlowGraph& graph,
                                            const std::vector<HopResult>& hops, std::uint32_t h);

/// From production to the start of the cycle in which the port sends the frame. Precondition: it has cycles.
Ps begins_at_least(const HopResult& hop);
Ps begins_at_most(const HopResult& hop);

}  // namespace takt::analysis
