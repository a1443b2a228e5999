// SPDX-License-Identifier: Apache-2.0
// Streams that say "route": "auto": the shortest path until another one is found.
#pragma once

#include <set>
#include <string>

#include "scenario/description/description.hpp"

namespace takt::synthesis {

/// Names of streams whose ways the scenario leaves open.
using OpenRoutes = std::set<std::string, std::less<>>;

/// Writes the shortest path where a stream says "route": "auto", and takes the word out. Mistakes of the scenario go to
/// `diagnostics`.
OpenRoutes write_shortest_paths(scenario::Scenario& scenario, json::Diagnostics& diagnostics);

}  // namespace takt::synthesis
