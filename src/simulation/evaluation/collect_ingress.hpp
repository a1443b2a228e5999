// SPDX-License-Identifier: Apache-2.0
// Reads the counters of ingress chains and of redundancy from a run.
#pragma once

#include <vector>

#include "results/ingress_result.hpp"
#include "scenario/run/run.hpp"

namespace takt::evaluation {

/// The switches whose ingress has met a frame.
std::vector<results::IngressResult> ingress_of(const scenario::Run& run);
/// Of switches, then of hosts.
results::RedundancyResult redundancy_of(const scenario::Run& run);

}  // namespace takt::evaluation
