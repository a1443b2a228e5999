// SPDX-License-Identifier: Apache-2.0
// Random problems of gates over random trees of switches.
#pragma once

#include <cstdint>

#include "scenario/resolved/gate_problem.hpp"

namespace takt::schedule_check {

/// Streams with random ways, periods and releases; most of them get into each other's way.
scenario::GateProblem random_problem(std::uint64_t seed);
/// The same without those streams that do not fit; at least one is left.
scenario::GateProblem random_problem_that_fits(std::uint64_t seed);

}  // namespace takt::schedule_check
