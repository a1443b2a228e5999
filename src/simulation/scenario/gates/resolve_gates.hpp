// SPDX-License-Identifier: Apache-2.0
// Gates that a scenario has for its whole network: laid out ("auto"), or listed.
#pragma once

#include <optional>

#include "scenario/gates/timing.hpp"
#include "scenario/resolved/resolved.hpp"

namespace takt::scenario {

struct StreamsToGate {
  GateProblem problem;
  std::vector<models::StreamIndex> streams;  ///< of the problem
};

/// What "auto" asks for: the scheduled streams, with their paths and times. Streams of a scheduled class whose frames
/// come at unknown times or by several ways, and ports that do something else to them, are diagnostics; then there is
/// no problem.
std::optional<StreamsToGate> gate_problem_of(const Resolved& resolved, const Timings& timings,
                                             json::Diagnostics& diagnostics);

/// Gives the ports of resolved.plan their gates, and streams and Programs with "offset": "auto" theirs. Laid-out lists
/// are written into resolved.scenario.gates, so that the resolved copy has them, and kept in resolved.gates. Conflicts
/// are diagnostics. To be called when the streams are there.
void resolve_gates_and_offsets(Resolved& resolved, json::Diagnostics& diagnostics);

}  // namespace takt::scenario
