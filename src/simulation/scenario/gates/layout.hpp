// SPDX-License-Identifier: Apache-2.0
// Automatic gates: a window for each stream and hop that begins when the frame can be there (no-wait), and the gate
// control lists of the ports that follow from the windows. Nothing is searched: what does not fit is said.
#pragma once

#include <vector>

#include "scenario/resolved/gate_problem.hpp"

namespace takt::scenario {

/// A schedule, or why there is none.
struct GateLayout {
  GateSolution schedule;                ///< whole if there are no conflicts
  std::vector<GateConflict> conflicts;  ///< at most one for each pair of streams and port
};

/// At the talker a window opens at the release, so that what the operating system takes does not show; behind it, a
/// margin before the frame is there. All windows close a margin after its end, on whole ns (outwards). A frame waits
/// only for those of its own train that it has followed since the talker. Where a window is open, and for the guard
/// before it, all other classes are closed.
GateLayout lay_out_gates(const GateProblem& problem);

}  // namespace takt::scenario
