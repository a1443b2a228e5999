// SPDX-License-Identifier: Apache-2.0
// Problems, solutions and certificates as neutral JSON.
#pragma once

#include "json/node.hpp"
#include "schedule/certificate.hpp"
#include "schedule/solution.hpp"

namespace takt::schedule_instances {

json::Node write_problem(const schedule::Problem& problem);
json::Node write_solution(const schedule::Problem& problem, const schedule::Solution& solution);
json::Node write_certificate(const schedule::Problem& problem, const schedule::Certificate& certificate);

}  // namespace takt::schedule_instances
