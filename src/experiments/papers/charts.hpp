// SPDX-License-Identifier: Apache-2.0
// From runs to the pictures of the paper.
#pragma once

#include <span>
#include <string>

#include "papers/programs.hpp"

namespace takt::papers {

/// Fig. 1: the state machine, from the table that the code runs on.
std::string state_machine_chart();

/// Simulated maxima (solid) and bounds (dashed) of each reaction over the rows of a table.
std::string reactions_chart(const BeyondTable& table);

}  // namespace takt::papers
