// SPDX-License-Identifier: Apache-2.0
// The paper's open questions, answered: reaction times by number of slaves, topology, nesting and load, simulated and
// bounded.
#pragma once

#include "papers/programs.hpp"

namespace takt::papers {

/// False if a plant is refused.
bool go_beyond(const ProgramsOptions& options, Reproduction& made, json::Diagnostics& diagnostics);

}  // namespace takt::papers
