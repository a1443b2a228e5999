// SPDX-License-Identifier: Apache-2.0
// Which port a trace record speaks of: from the component that recorded it to node, number and link.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "models/network.hpp"

namespace takt::models {

/// A port of a network, by node and number.
struct PortId {
  NodeIndex node;
  std::uint16_t port = 0;
  auto operator<=>(const PortId&) const = default;
};

class PortDirectory {
 public:
  struct Port {
    PortId id;
    NodeIndex peer;
    sim::Duration octet_time;  ///< of its link
    sim::ComponentId component;
  };

  explicit PortDirectory(const Network& network);

  /// All ports, by node and number.
  std::span<const Port> ports() const { return ports_; }
  /// The position in ports() of the port with that component, or none.
  static constexpr std::uint32_t none = 0xFFFF'FFFF;
  std::uint32_t find(sim::ComponentId component) const {
    return component.index < by_component_.size() ? by_component_[component.index] : none;
  }
  std::uint32_t find(PortId id) const;

 private:
  std::vector<Port> ports_;
  std::vector<std::uint32_t> by_component_;
};

}  // namespace takt::models
