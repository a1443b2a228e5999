// SPDX-License-Identifier: Apache-2.0
// Networks as levels of a factor: those of the generators of scenarios, and GraphML files.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "study/description.hpp"

namespace takt::study {

/// A graph of a file before it is a network.
struct PlainGraph {
  struct Node {
    std::string name;
    bool is_host = false;
  };
  struct Link {
    std::size_t a = 0;
    std::size_t b = 0;
    std::string rate;    ///< empty: the topology's
    std::string length;  ///< empty: the topology's
  };
  std::vector<Node> nodes;
  std::vector<Link> links;
};

/// The "network" of a scenario; files are sought in the folder. Mistakes are diagnostics; the node is then empty.
json::Node network_of(const TopologyLevel& level, const std::string& folder, json::Diagnostics& diagnostics);

/// Reads a GraphML file. Nodes may have data "name" and "kind" (host or switch, the default), edges "rate" and
/// "length", all texts. Nothing and `problem` if it cannot be read.
std::optional<PlainGraph> read_graphml(const std::string& path, std::string& problem);

}  // namespace takt::study
