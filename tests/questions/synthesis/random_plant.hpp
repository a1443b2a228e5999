// SPDX-License-Identifier: Apache-2.0
// Random scheduled plants and changes of them, for tests of transitions.
#pragma once

#include <optional>
#include <string>

#include "synthesis/scenario_change.hpp"

namespace takt::synthesis::test {

struct RandomPlant {
  scenario::Scenario wanted;   ///< with "offset": "auto"
  scenario::Scenario running;  ///< scheduled
  AskedChanges asked;          ///< streams that come and go, and links that fail
};

scenario::Scenario scenario_of(const std::string& text);
/// Of a scenario that has a schedule.
scenario::Scenario scheduled(const scenario::Scenario& wanted);
/// The same for a seed; nothing if its streams find no place.
std::optional<RandomPlant> random_plant(std::uint64_t seed);

}  // namespace takt::synthesis::test
