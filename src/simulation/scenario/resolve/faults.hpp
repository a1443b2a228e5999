// SPDX-License-Identifier: Apache-2.0
// Faults: from the description to actions of the script, impairments of links and additional talkers.
#pragma once

#include <set>
#include <utility>
#include <vector>

#include "scenario/resolved/resolved.hpp"

namespace takt::scenario {

/// What goes wrong.
struct FaultPlan {
  std::vector<ResolvedAction> actions;  ///< in no order
  std::vector<models::ImpairmentPlan> impairments;
  std::vector<models::TalkerPlan> babblers;
  std::set<std::uint32_t> failing_links;                          ///< in plan.links
  std::set<std::pair<std::uint32_t, std::uint16_t>> stuck_ports;  ///< nodes and ports of gates
};
/// Nodes, links and streams are there. Links that do not exist, unknown nodes and streams are diagnostics.
FaultPlan plan_faults(const Resolved& resolved, json::Diagnostics& diagnostics);

}  // namespace takt::scenario
