// SPDX-License-Identifier: Apache-2.0
// The clocks of the nodes and gPTP: from the description to the plan.
#pragma once

#include "scenario/resolved/resolved.hpp"

namespace takt::scenario {

/// As NetworkPlan has them; empty without clocks, without gPTP.
struct ClockPlans {
  std::vector<std::optional<models::NodeClockPlan>> of_nodes;
  std::vector<std::optional<std::uint32_t>> gptp;
  std::vector<models::gptp::StationPlan> gptp_stations;
};
/// Of the nodes and links of the plan. Unknown nodes, roles that cannot be, domains twice and the like are diagnostics.
ClockPlans plan_clocks(const Resolved& resolved, json::Diagnostics& diagnostics);

}  // namespace takt::scenario
