// SPDX-License-Identifier: Apache-2.0
// What a network's graph is like, as figures that requirements and studies can look at.
#pragma once

#include <cstddef>
#include <optional>

#include "json/record.hpp"
#include "scenario/resolved/resolved.hpp"

namespace takt::scenario {

struct GraphFigures {
  std::size_t switches = 0;
  std::size_t links = 0;
  std::optional<std::size_t> diameter;
  std::size_t bridges = 0;
  std::optional<std::size_t> disjoint_paths;
};
const json::Record& describe(json::Type<GraphFigures>);

GraphFigures graph_figures_of(const Resolved& resolved);
/// They as requirements and studies look at them, beside the figures of a run.
json::Node topology_node(const Resolved& resolved);

}  // namespace takt::scenario
