// Which assumptions of bounds the scenario itself discharges, leaves open or contradicts.
#pragma once

#include <optional>
#include <string>

#include "analysis/assumption_ledger.hpp"
#include "analysis/bounds.hpp"
#include "analysis/flow_graph.hpp"

namespace takt::analysis {

/// How good the clocks are that gPTP holds together, and who says so.
struct ClockPremise {
  sim::Duration error;
  sim::Duration after;                       ///< since the start
  std::optional<std::size_t> requirement;    ///< in Resolved::requirements; nothing: BoundOptions::clock_error
};
ClockPremise clock_premise(const scenario::Resolved& resolved, const BoundOptions& options);

AssumptionLedger assess(const scenario::Resolved& resolved, const FlowGraph& graph, const BoundOptions& options);

}  // namespace takt::analysis
