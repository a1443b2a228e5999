// SPDX-License-Identifier: Apache-2.0
// Phases that a scenario leaves open: of talkers and publishers. The scenario need not be sound.
#pragma once

#include <string>
#include <vector>

#include "verify/free_variable.hpp"

namespace takt::verify {

void add_free_talkers(const scenario::Scenario& scenario, std::vector<FreeVariable>& found);
void add_free_publishers(const scenario::Scenario& scenario, std::vector<FreeVariable>& found);

/// The master, then the slaves.
const std::string& participant_name(const scenario::Program& program, std::size_t participant);

}  // namespace takt::verify
