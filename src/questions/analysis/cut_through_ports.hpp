// SPDX-License-Identifier: Apache-2.0
// Ports that surely cut frames through: what starts before its last bit is in comes sooner everywhere behind.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "analysis/flow_graph.hpp"
#include "analysis/network_bound.hpp"

namespace takt::analysis {

/// Whether a port cuts all frames through whatever happens: they come by one link of the same rate, which keeps them a
/// gap apart, and nothing else asks for the port. Then the last bit leaves so much after it has come as the header
/// takes to be there.
std::optional<Ps> header_of_all(const scenario::Resolved& resolved, const FlowGraph& graph, std::uint32_t port);

/// By how much a frame starts sooner than its last bit is there if it is cut through, at a port with gates where
/// nothing but times says whether it is.
std::optional<Ps> header_ahead(const scenario::Resolved& resolved, const FlowGraph& graph, std::uint32_t hop);

/// A port with gates at which headers come at known times: if then none of their frames waits, all of them are cut
/// through. The first one that was not would have met another one, or a closed gate. Nothing if it is not known.
/// `hops`: what is known of all hops. `ahead`: by hop.
std::optional<PortBound> bound_cut_through(const scenario::Resolved& resolved, const FlowGraph& graph,
                                           std::uint32_t port, const PortTraffic& traffic,
                                           const std::vector<HopResult>& hops,
                                           const std::vector<std::optional<Ps>>& ahead);

}  // namespace takt::analysis
