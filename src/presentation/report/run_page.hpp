// SPDX-License-Identifier: Apache-2.0
// The page of a run.
#pragma once

#include <string>

#include "report/replay.hpp"
#include "results/run_result.hpp"
#include "scenario/resolved/resolved.hpp"

namespace takt::report {

/// The verdict in a sentence, requirements as bars, the network, gates and frames of a cycle, latencies, every kind of
/// reaction as a sequence chart, clocks and drops. `replay` has advanced.
std::string run_page(const scenario::Resolved& resolved, const results::RunResult& result, const Replay& replay);

}  // namespace takt::report
