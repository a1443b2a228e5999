// SPDX-License-Identifier: Apache-2.0
#include "synthesis/open_routes.hpp"

#include <algorithm>

#include "scenario/resolve.hpp"

namespace takt::synthesis {

OpenRoutes write_shortest_paths(scenario::Scenario& scenario, json::Diagnostics& diagnostics) {
  OpenRoutes open;
  if (std::ranges::none_of(scenario.streams, [](const scenario::Stream& stream) { return stream.route.has_value(); }))
    return open;
  // Paths are laid without gates and offsets, and whether all of them together are too much is asked later.
  scenario::Scenario bare = scenario;
  bare.gates.reset();
  bare.allow_overload = true;
  const auto resolved = scenario::resolve(bare, diagnostics);
  if (!resolved || diagnostics.has_errors()) return open;
  for (scenario::Stream& stream : scenario.streams) {
    if (!stream.route) continue;
    const auto laid = std::ranges::find_if(resolved->streams, [&](const scenario::ResolvedStream& each) {
      return resolved->plan.streams[each.index.value].name == stream.name;
    });
    auto& path = stream.path.emplace();
    for (const std::uint32_t node : laid->paths.front()) path.push_back(resolved->topology.nodes[node].name);
    stream.route.reset();
    open.insert(stream.name);
  }
  return open;
}

}  // namespace takt::synthesis
