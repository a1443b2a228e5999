// SPDX-License-Identifier: Apache-2.0
// "offset": "auto": phases of streams and Programs that takt chooses before the run.
#pragma once

#include "scenario/gates/timing.hpp"
#include "scenario/gates/resolve_gates.hpp"
#include "scenario/resolved/resolved.hpp"

namespace takt::scenario {

/// Of streams that get windows: chooses what is open, so that no windows overlap, and moves the releases in `gated` and
/// `timings`. What does not fit is an error, and then the answer is false.
bool choose_gated_offsets(Resolved& resolved, Timings& timings, StreamsToGate& gated, json::Diagnostics& diagnostics);

/// Of all others: chooses what is still open, so that their frames meet none of those that come at known times, gated
/// or not, if nothing holds them up on their way. Where that cannot be they meet as few as possible, and a warning says
/// whom.
void choose_other_offsets(Resolved& resolved, Timings& timings, json::Diagnostics& diagnostics);

}  // namespace takt::scenario
