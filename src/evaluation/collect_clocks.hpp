// From a run to what its clocks did.
#pragma once

#include <vector>

#include "results/clock_result.hpp"
#include "scenario/run/run.hpp"

namespace takt::evaluation {

/// One for each node with gPTP; empty without it.
std::vector<results::ClockResult> clocks_of(const scenario::Run& run, sim::Duration from);

}  // namespace takt::evaluation
