// SPDX-License-Identifier: Apache-2.0
// Table I and Fig. 8: round trips of 1 to 20 values.
#pragma once

#include "papers/programs.hpp"

namespace takt::papers {

/// False if a scenario cannot be read.
bool reproduce_round_trips(const ProgramsOptions& options, Reproduction& made, json::Diagnostics& diagnostics);

}  // namespace takt::papers
