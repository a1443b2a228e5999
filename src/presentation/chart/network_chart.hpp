// SPDX-License-Identifier: Apache-2.0
// A network drawn: nodes, links, the load of links as colour, failed ones marked.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "chart/svg.hpp"

namespace takt::chart {

struct NetworkNode {
  enum class Kind { host, bridge, station };
  std::string name;
  Kind kind = Kind::host;
  bool has_failed = false;
  std::string title;  ///< shown when the mouse rests on it
};

struct NetworkLink {
  std::size_t a = 0;
  std::size_t b = 0;
  double load = 0;  ///< share of the busier direction, 0 to 1
  bool has_failed = false;
  std::string title;
};

struct NetworkChart {
  std::string title;
  std::vector<NetworkNode> nodes;
  std::vector<NetworkLink> links;
};

/// Of a network with more than 300 hosts those that hang on one switch are left out; names stand there while they are
/// few.
std::string draw(const NetworkChart& chart);

/// Where each node stands, neighbouring switches about 1 apart; nothing for those that are left out.
std::vector<std::optional<Point>> places(const NetworkChart& chart);

struct LoadColour {
  double below = 0;  ///< shares less than this, and not of the step before
  std::string_view colour;
  std::string_view text;
};
/// Few steps that can be told apart, also without red and green.
std::span<const LoadColour> load_colours();
std::string_view colour_of_load(double share);

}  // namespace takt::chart
