// SPDX-License-Identifier: Apache-2.0
// The part of a text report on the processors of hosts.
#pragma once

#include <string>

#include "results/run_result.hpp"

namespace takt::output {

/// Empty where there are none.
std::string cpus_part(const results::RunResult& result);

}  // namespace takt::output
