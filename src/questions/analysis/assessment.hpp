// SPDX-License-Identifier: Apache-2.0
// Which assumptions of bounds the scenario itself discharges, leaves open or contradicts.
#pragma once

#include <optional>
#include <string>

#include "analysis/assumption_ledger.hpp"
#include "analysis/bounds.hpp"
#include "analysis/flow_graph.hpp"

namespace takt::analysis {

/// How far clocks that gPTP holds together may differ on a way, and what says so.
struct ClockPremise {
  sim::Duration error;  ///< of each clock from a time that all of them share: that of their grandmaster, or the middle
                        ///< between the outermost two
  sim::Duration after;  ///< since the start
  std::optional<std::size_t> requirement;  ///< in Resolved::requirements; nothing: BoundOptions::clock_error
  /// Between two nodes on a way.
  sim::Duration difference() const { return error * 2; }
};
/// By requirements on all clocks ("sync"), and on the differences of all clocks that matter ("clocks").
ClockPremise clock_premise(const scenario::Resolved& resolved, const BoundOptions& options);

AssumptionLedger assess(const scenario::Resolved& resolved, const FlowGraph& graph, const BoundOptions& options);

}  // namespace takt::analysis
