// SPDX-License-Identifier: Apache-2.0
// Generated topologies: line, ring, star, tree, mesh, comb, random, dual star.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "models/plan.hpp"
#include "scenario/description/description.hpp"

namespace takt::scenario {

/// What a generator makes, before names are joined with those written by hand.
struct Generated {
  struct Node {
    std::string name;
    models::NodeKind kind = models::NodeKind::host;
  };
  struct Link {
    std::uint32_t a = 0;  ///< index into nodes
    std::uint32_t b = 0;
    bool to_host = false;
  };
  std::vector<Node> nodes;
  std::vector<Link> links;
};

/// Makes the topology, at most `room` nodes. Missing or senseless parameters and too many nodes are diagnostics; then
/// nothing is generated.
Generated generate(const Generator& generator, std::uint64_t room, json::Diagnostics& diagnostics);

}  // namespace takt::scenario
