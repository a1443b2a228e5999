// SPDX-License-Identifier: Apache-2.0
// From a run to what its clocks did.
#pragma once

#include <vector>

#include "results/clock_result.hpp"
#include "scenario/run/run.hpp"

namespace takt::evaluation {

/// One for each node with gPTP; empty without it.
std::vector<results::ClockResult> clocks_of(const scenario::Run& run, sim::Duration from);
/// Who gave the time when, by the histories of the clocks.
std::vector<results::GrandmasterResult> grandmasters_of(const std::vector<results::ClockResult>& clocks);
std::vector<results::GptpLinkResult> gptp_links_of(const scenario::Run& run);
/// One for each group of nodes whose clocks are compared.
std::vector<results::ClockDifferenceResult> clock_differences_of(const scenario::Run& run, sim::Duration from);

}  // namespace takt::evaluation
