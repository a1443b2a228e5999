// SPDX-License-Identifier: Apache-2.0
// A found run as a scenario: when each call is made and which messages get through, so that `takt run` does the same.
//
// All publish at the beginning of each millisecond and every message takes the same time; a message that the run does
// not hear is lost. What cannot be said in a scenario is listed in `missing`.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "explore/model/query.hpp"
#include "explore/properties/property.hpp"
#include "explore/report/replay.hpp"

namespace takt::explore {

struct ScenarioText {
  std::string json;
  std::vector<std::string> missing;  ///< what of the run is not in it; then it may not do the same
};

/// `name` becomes the scenario's; `property` is what is to be seen.
ScenarioText scenario_of(const Query& query, const Replay& replayed, Property property, const std::string& name);

}  // namespace takt::explore
