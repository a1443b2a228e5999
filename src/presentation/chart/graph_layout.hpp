// SPDX-License-Identifier: Apache-2.0
// Where the nodes of a network stand in a picture: lines straight, rings round, trees in layers, meshes so that
// distances look like numbers of links.
#pragma once

#include <cstddef>
#include <utility>
#include <vector>

#include "chart/svg.hpp"

namespace takt::chart {

struct Graph {
  std::vector<bool> is_hub;  ///< by node: it joins others (a switch); what hangs on one hub alone stands around it
  std::vector<std::pair<std::size_t, std::size_t>> edges;  ///< between different nodes
};

/// A point for each node; neighbouring hubs stand about 1 apart. The same on every machine for the same graph.
std::vector<Point> layout(const Graph& graph);

}  // namespace takt::chart
