// A network drawn: nodes, links, the load of links as colour, failed ones marked.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace takt::chart {

struct NetworkNode {
  enum class Kind { host, bridge, station };
  std::string name;
  Kind kind = Kind::host;
  bool has_failed = false;
  std::string title;          ///< shown when the mouse rests on it
};

struct NetworkLink {
  std::size_t a = 0;
  std::size_t b = 0;
  double load = 0;            ///< share of the busier direction, 0 to 1
  bool has_failed = false;
  std::string title;
};

struct NetworkChart {
  std::string title;
  std::vector<NetworkNode> nodes;
  std::vector<NetworkLink> links;
};

/// Of a network with more than 300 hosts those that hang on one switch are left out; names stand there while they are few.
std::string draw(const NetworkChart& chart);

}  // namespace takt::chart
