// SPDX-License-Identifier: Apache-2.0
// Which parts a node of each kind has.
#include <type_traits>

#include "scenario/description/description.hpp"

namespace takt::scenario {
namespace {

/// The part of that type, or null.
template <class Part, class AnyNode>
auto* part_of(AnyNode& node) {
  using Found = std::conditional_t<std::is_const_v<AnyNode>, const Part, Part>;
  return std::visit(
      [](auto& each) -> Found* {
        if constexpr (std::is_base_of_v<Part, std::remove_cvref_t<decltype(each)>>)
          return &each;
        else
          return nullptr;
      },
      node);
}

}  // namespace

const EndStation* end_station_of(const Node& node) { return part_of<EndStation>(node); }
EndStation* end_station_of(Node& node) { return part_of<EndStation>(node); }
const Relay* relay_of(const Node& node) { return part_of<Relay>(node); }
Relay* relay_of(Node& node) { return part_of<Relay>(node); }
const NodePorts& ports_of(const Node& node) { return *part_of<NodePorts>(node); }
NodePorts& ports_of(Node& node) { return *part_of<NodePorts>(node); }

const json::Source& source_of(const Node& node) {
  return std::visit([](const auto& each) -> const json::Source& { return each.where; }, node);
}

}  // namespace takt::scenario
