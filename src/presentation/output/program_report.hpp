// SPDX-License-Identifier: Apache-2.0
// What the page of a run says of a Program: its time line, reactions, round trips, violations.
#pragma once

#include <string>

#include "output/table.hpp"
#include "results/run_result.hpp"

namespace takt::output {

std::string program_part(const results::ProgramResult& program, const Layout& layout);

}  // namespace takt::output
