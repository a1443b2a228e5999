// SPDX-License-Identifier: Apache-2.0
// What the processors of hosts did in a run.
#pragma once

#include <vector>

#include "results/cpu_result.hpp"
#include "scenario/run/run.hpp"

namespace takt::evaluation {

/// The figures of what began at `from` or later.
std::vector<results::CpuResult> cpus_of(const scenario::Run& run, sim::Duration from);

}  // namespace takt::evaluation
