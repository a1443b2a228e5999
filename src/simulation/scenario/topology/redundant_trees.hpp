// SPDX-License-Identifier: Apache-2.0
// Two trees from one sender to many receivers, so that whatever single link or node fails, each receiver that can be
// reached at all is reached by one of them.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "scenario/topology/routing.hpp"
#include "scenario/topology/topology.hpp"

namespace takt::scenario {

/// Redundant trees (Médard, Finn, Barry and Gallager 1999): nodes are put in an order, ear by ear; on the way to a node
/// one tree goes over earlier nodes only, the other over later ones. Where a single node or link is the only way to a
/// part of the network, both trees take it, and part again behind it. Of nodes that forward; a host hangs at two of
/// them if it can.
class RedundantTrees {
 public:
  RedundantTrees(const Topology& topology, std::uint32_t from);

  /// The paths from the sender to that node in both trees; nothing if it cannot be reached.
  std::optional<std::array<Path, 2>> to(std::uint32_t node) const;

 private:
  struct Parents {
    std::array<std::uint32_t, 2> of;  ///< in each tree
  };
  bool is_in(std::uint32_t node) const { return parents_[node].has_value(); }
  bool grows_to(std::uint32_t node) const { return !is_in(node) && topology_.nodes[node].forwards(); }
  bool may_grow_from(std::uint32_t node) const;
  Path path_in(std::size_t tree, std::uint32_t node) const;
  void grow(std::uint32_t root);
  bool add_ear(std::uint32_t root);
  std::vector<std::uint32_t> find_ear(std::uint32_t root, std::uint32_t from, std::uint32_t first) const;
  void insert(std::uint32_t root, std::vector<std::uint32_t> ear);
  std::size_t place_of(std::uint32_t node) const;

  const Topology& topology_;
  std::uint32_t from_;
  std::vector<std::optional<Parents>> parents_;  // by node
  std::vector<std::uint32_t> order_;  // of the block that grows, without its root, which is before and behind all
};

/// How many links both paths take.
std::size_t shared_links(const Path& a, const Path& b);

}  // namespace takt::scenario
