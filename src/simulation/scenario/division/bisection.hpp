// SPDX-License-Identifier: Apache-2.0
// A graph in two parts of about the same weight with little between them.
#pragma once

#include <cstdint>
#include <vector>

namespace takt::scenario {

/// Undirected, with weights. Vertices are numbered from 0.
struct WeightedGraph {
  struct Edge {
    std::uint32_t to = 0;
    double weight = 0;
  };
  std::vector<double> weights;           ///< by vertex
  std::vector<std::vector<Edge>> edges;  ///< by vertex; each edge stands at both its ends
};

/// By vertex: whether it is in the second part. The first part has about `share` of the weight, and vertex `fixed`, if
/// it is one. Greedy growth from several vertices and moves by gain (Fiduccia and Mattheyses, "A linear-time heuristic
/// for improving network partitions", 1982); the same result on every machine.
std::vector<bool> bisect(const WeightedGraph& graph, double share, std::uint32_t fixed = 0xFFFF'FFFF);

}  // namespace takt::scenario
