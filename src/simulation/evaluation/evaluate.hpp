// SPDX-License-Identifier: Apache-2.0
// From a run to its result: figures, requirements, verdict.
#pragma once

#include <vector>

#include "results/run_result.hpp"
#include "scenario/run/run.hpp"

namespace takt::evaluation {

/// `partial`: the run was interrupted; what has not failed is then undecided.
results::RunResult evaluate(const scenario::Run& run, bool partial);

/// Leaves out the requirements that are not asked for, by their place in the result; the verdict is that of the others.
void keep_requirements(results::RunResult& result, const std::vector<bool>& asked);

}  // namespace takt::evaluation
