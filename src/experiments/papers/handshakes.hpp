// SPDX-License-Identifier: Apache-2.0
// Fig. 1 from the state table, Fig. 3 to 6 from runs.
#pragma once

#include "papers/programs.hpp"

namespace takt::papers {

/// False if a scenario cannot be read.
bool reproduce_handshakes(const ProgramsOptions& options, Reproduction& made, json::Diagnostics& diagnostics);

}  // namespace takt::papers
