// SPDX-License-Identifier: Apache-2.0
// From a run to what its applications and signals did.
#pragma once

#include <vector>

#include "results/application_result.hpp"
#include "scenario/run/run.hpp"

namespace takt::evaluation {

/// In the order of the scenario, gateways behind applications.
std::vector<results::ApplicationResult> applications_of(const scenario::Run& run, sim::Duration from);
std::vector<results::SignalResult> signals_of(const scenario::Run& run, sim::Duration from);

}  // namespace takt::evaluation
