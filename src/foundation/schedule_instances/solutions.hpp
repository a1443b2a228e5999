// SPDX-License-Identifier: Apache-2.0
// Schedules that were written, and streams that come to a network.
#pragma once

#include <vector>

#include "json/document.hpp"
#include "schedule/solution.hpp"

namespace takt::schedule_instances {

/// A neutral solution of the problem, without its gate lists. What it says may be wrong; what it names is there.
schedule::Solution read_solution(const json::Document& document, const schedule::Problem& problem,
                                 json::Diagnostics& diagnostics);
/// {"streams": [...]} as in a neutral problem: streams that the problem has not, between nodes that it has.
std::vector<schedule::Stream> read_streams(const json::Document& document, const schedule::Problem& problem,
                                           json::Diagnostics& diagnostics);

}  // namespace takt::schedule_instances
