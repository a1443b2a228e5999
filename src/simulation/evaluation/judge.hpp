// SPDX-License-Identifier: Apache-2.0
// What a run shows of what the scenario requires.
#pragma once

#include <map>
#include <string_view>

#include "results/run_result.hpp"
#include "scenario/figures/requirement.hpp"
#include "scenario/run/run.hpp"

namespace takt::evaluation {

/// What a run shows from an instant on, in the ways in which requirements ask for it.
struct Figures {
  results::RunResult result;  // without verdicts
  json::Node node = {};       // as result.json has it, if a requirement asks for a figure
  std::map<std::string_view, const results::StreamResult*> streams = {};  // by name
};

/// The verdict on a limit; `figures` are those of the instant from which it counts. Of a run that was interrupted
/// (`partial`) only what no later event mends is a failure.
results::RequirementResult judge(const scenario::Run& run, const scenario::RequiredFigure& required,
                                 const Figures& figures, bool partial);

/// Every Program keeps its invariants, whether or not a requirement says so.
results::RequirementResult judge_invariants(const results::ProgramResult& program, bool partial);

}  // namespace takt::evaluation
