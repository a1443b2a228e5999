// A requirement on a figure, as the requirement of another kind that asks the same.
#pragma once

#include "results/run_result.hpp"
#include "scenario/description/description.hpp"

namespace takt::verify {

/// One that limits the greatest latency of a stream or the longest reaction by a figure, as a requirement on a latency or a reaction; any other as it
/// is, but with the stream as its subject if it is about the latencies of one ("*": of all).
results::RequirementResult plain(const scenario::Scenario& scenario, const results::RequirementResult& requirement);

}  // namespace takt::verify
