// SPDX-License-Identifier: Apache-2.0
// What the switches' tables become when links and nodes are down.
#pragma once

#include "scenario/resolved/resolved.hpp"

namespace takt::scenario {

/// Something goes down or comes back at an instant.
struct Outage {
  sim::TrueTime at;
  std::vector<std::uint32_t> links;  ///< indices into plan.links
  bool up = false;
};

/// `delay` after each outage, the entries of the filtering databases that lead along the shortest paths that are left
/// then. Streams with a given path keep it, and so does a receiver that cannot be reached. The outages are in the order
/// of time.
std::vector<ResolvedAction> plan_rerouting(const Resolved& resolved, const std::vector<Outage>& outages,
                                           Duration delay);

}  // namespace takt::scenario
