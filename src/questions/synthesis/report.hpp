// SPDX-License-Identifier: Apache-2.0
// What takt schedule says about a scenario.
#pragma once

#include "json/record.hpp"
#include "synthesis/scenario_schedule.hpp"

namespace takt::synthesis {

const json::Record& describe(json::Type<JudgedStream>);
const json::Record& describe(json::Type<StreamRequirement>);
const json::Record& describe(json::Type<ScenarioSchedule>);
/// A few lines for people.
std::string text_of(const std::string& name, const ScenarioSchedule& answer);

}  // namespace takt::synthesis
