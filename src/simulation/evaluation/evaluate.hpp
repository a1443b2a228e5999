// SPDX-License-Identifier: Apache-2.0
// From a run to its result: figures, requirements, verdict.
#pragma once

#include "results/run_result.hpp"
#include "scenario/run/run.hpp"

namespace takt::evaluation {

/// `partial`: the run was interrupted; what has not failed is then undecided.
results::RunResult evaluate(const scenario::Run& run, bool partial);

}  // namespace takt::evaluation
