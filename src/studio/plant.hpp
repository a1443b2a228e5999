// The network as the page draws it and as it is dragged about.
#pragma once

#include <string>

#include "chart/network_chart.hpp"

namespace takt::studio {

/// JSON: {"nodes": [{"name", "kind": "host" | "switch" | "station", "title", "failed", "x", "y"}], "links": [{"a", "b", "colour", "title", "failed"}],
/// "legend": [{"colour", "text"}], "hidden": N}. a and b are positions in `nodes`; nodes that are hidden, because they are many, are left out with their links.
std::string plant_json(const chart::NetworkChart& network);

}  // namespace takt::studio
