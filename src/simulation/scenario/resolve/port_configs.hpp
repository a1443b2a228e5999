// SPDX-License-Identifier: Apache-2.0
// The configurations of ports in a plan: of a port its own, or that of its node. Equal ones share their entry.
#pragma once

#include "models/plan.hpp"
#include "scenario/topology/topology.hpp"

namespace takt::scenario {

const models::PortConfig& port_config_of(const models::NetworkPlan& plan, const models::LinkPlan::End& end);
/// What ports of a node have before its "egress": classes and the limits of queues.
models::PortConfig port_config_of(const NodePorts& ports);
/// The entry of such a configuration, which is made if there is none.
std::uint32_t port_config_index(models::NetworkPlan& plan, const models::PortConfig& config);

/// Whether the port takes C-tags off. What a host with one interface sends leaves as it was made.
inline bool strips_tags(const Topology& topology, const models::PortConfig& config, std::uint32_t node,
                        bool is_talker) {
  return config.untagged && (!is_talker || topology.chooses_ports[node]);
}

/// Which ports got gates.
struct GatesSet {
  bool found = false;  ///< one at least
  bool twice = false;  ///< one had gates before
};
/// Of the ports of the node those whose peer, the other end of the link, is meant.
template <class IsMeant>
GatesSet set_gates(models::NetworkPlan& plan, models::NodeIndex node, const models::GateConfig& gates,
                   IsMeant&& is_meant) {
  GatesSet set;
  for (models::LinkPlan& link : plan.links)
    for (auto [end, peer] : {std::pair(&link.a, &link.b), std::pair(&link.b, &link.a)}) {
      if (end->node != node || !is_meant(*peer)) continue;
      models::PortConfig config = port_config_of(plan, *end);
      set.found = true;
      set.twice = set.twice || config.shaping.gates.has_value();
      config.shaping.gates = gates;
      end->port_config = port_config_index(plan, config);
    }
  return set;
}

}  // namespace takt::scenario
