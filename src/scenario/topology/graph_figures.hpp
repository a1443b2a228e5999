// What a network's graph is like, as figures that requirements and studies can look at.
#pragma once

#include "scenario/json/node.hpp"
#include "scenario/resolve/resolved.hpp"

namespace takt::scenario {

/// {"switches", "links" between them, "diameter" (links on the longest of the shortest paths between switches; null if some
/// are not joined), "bridges" (links between switches whose failure parts the network), "disjoint_paths" (the fewest
/// node-disjoint paths between the switches of a Program's master and of a slave; null without Programs or if both hang at one switch)}
json::Node topology_node(const Resolved& resolved);

}  // namespace takt::scenario
