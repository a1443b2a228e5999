// SPDX-License-Identifier: Apache-2.0
// The plant of a scenario as a picture: how busy its links were in a run, and what failed.
#pragma once

#include "chart/network_chart.hpp"
#include "results/run_result.hpp"
#include "scenario/resolved/resolved.hpp"

namespace takt::report {

/// `result` is of a run of `resolved`; null: the loads are those that streams ask for on average.
chart::NetworkChart network_figure(const scenario::Resolved& resolved, const results::RunResult* result);

}  // namespace takt::report
