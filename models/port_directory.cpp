// SPDX-License-Identifier: Apache-2.0
#include "models/port_directory.hpp"

#include <algorithm>

namespace takt::models {

PortDirectory::PortDirectory(const Network& network) {
  const NetworkPlan& plan = network.plan();
  for (std::uint32_t n = 0; n < plan.nodes.size(); ++n) {
    const std::span<const EgressPort> ports = network.ports({n});
    for (std::size_t p = 0; p < ports.size(); ++p) {
      const sim::ComponentId component = ports[p].id();
      ports_.push_back({{{n}, static_cast<std::uint16_t>(p)}, {}, {}, component});
      if (!ports[p].is_connected()) continue;  // it is no component: its number is that of another one
      if (by_component_.size() <= component.index) by_component_.resize(component.index + std::size_t{1}, none);
      by_component_[component.index] = static_cast<std::uint32_t>(ports_.size()) - 1;
    }
  }
  const auto connect = [&](const LinkPlan::End& from, const LinkPlan::End& to, const LinkPlan& link) {
    const std::uint32_t position = find(PortId{from.node, from.port});
    TAKT_CHECK(position != none, "a link ends at a port");
    ports_[position].peer = to.node;
    ports_[position].octet_time = link.rate.octet_time();
  };
  for (const LinkPlan& link : plan.links) {
    connect(link.a, link.b, link);
    connect(link.b, link.a, link);
  }
}

std::uint32_t PortDirectory::find(PortId id) const {
  const auto found =
      std::lower_bound(ports_.begin(), ports_.end(), id, [](const Port& port, PortId key) { return port.id < key; });
  return found != ports_.end() && found->id == id ? static_cast<std::uint32_t>(found - ports_.begin()) : none;
}

}  // namespace takt::models
