// SPDX-License-Identifier: Apache-2.0
// What must hold: the spellings of scenario files become limits on figures; what is said belongs together, and speaks
// of what is there.
#pragma once

#include <string>

#include "scenario/resolved/resolved.hpp"

namespace takt::scenario {

/// All else is resolved by then.
std::vector<RequiredFigure> requirements_of(const Resolved& resolved, json::Diagnostics& diagnostics);

/// The Program of that name; nothing and a diagnostic at `place` if there is none.
const Program* find_program(const Scenario& scenario, const std::string& name, const json::Place& place,
                            json::Diagnostics& diagnostics);

}  // namespace takt::scenario
