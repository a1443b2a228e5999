// The same plant with less waiting, so that a search can afford many runs of it.
#pragma once

#include "scenario/description/description.hpp"

namespace takt::verify {

/// Calls of the script come closer to each other, and the end to the last one, where nothing but the Programs' cycles goes on in between. What
/// is left between two of them is long enough for `longest_reaction`, for an initialisation and a time-out, and the same in phase. A
/// scenario in which more depends on when something happens (gPTP, clocks, faults, other gate lists, traces) stays as it is.
scenario::Scenario shortened(const scenario::Scenario& scenario, sim::Duration longest_reaction);

}  // namespace takt::verify
