// SPDX-License-Identifier: Apache-2.0
// The claims of the paper's conclusion: one way, cycles of 1 to 10 ms with less than a kilobyte, a robot at 1 kHz.
#pragma once

#include "papers/programs.hpp"

namespace takt::papers {

/// False if a scenario cannot be read.
bool check_claims(const ProgramsOptions& options, Reproduction& made, json::Diagnostics& diagnostics);

}  // namespace takt::papers
