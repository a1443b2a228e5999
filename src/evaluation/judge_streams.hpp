// What a run shows of a requirement on a stream.
#pragma once

#include <vector>

#include "results/run_result.hpp"
#include "scenario/description/description.hpp"

namespace takt::evaluation {

/// One verdict for each limit of the requirement, in the order latency, jitter, dropped, delivered. `stream` is the account from the instant on from
/// which the requirement counts. Of a run that was interrupted (`partial`) only what no later event mends is a failure.
std::vector<results::RequirementResult> judge_stream(const scenario::Scenario& scenario, const scenario::Requirement& requirement, const results::StreamResult& stream, bool partial);

}  // namespace takt::evaluation
