// SPDX-License-Identifier: Apache-2.0
// What reports say of applications, gateways and signals.
#pragma once

#include <string>

#include "results/run_result.hpp"

namespace takt::output {

/// Empty if there are none.
std::string applications_part(const results::RunResult& result);

}  // namespace takt::output
