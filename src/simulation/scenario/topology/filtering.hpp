// SPDX-License-Identifier: Apache-2.0
// What a path asks of the filtering databases along it.
#pragma once

#include "models/bridge/internal_port.hpp"
#include "scenario/topology/routing.hpp"
#include "scenario/topology/topology.hpp"

namespace takt::scenario {

/// Calls visit(position in the path, port) for each node of the path that needs an entry: the port to the next node
/// where there is a choice of ports, the internal one of a station at the end.
template <class Visit>
void for_each_entry(const Topology& topology, const Path& path, Visit&& visit) {
  for (std::size_t at = 0; at + 1 < path.size(); ++at)
    if (topology.chooses_ports[path[at]]) visit(at, port_out(topology, path, at));
  if (topology.nodes[path.back()].forwards()) visit(path.size() - 1, models::internal_port);
}

}  // namespace takt::scenario
