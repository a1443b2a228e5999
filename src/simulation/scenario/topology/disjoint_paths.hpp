// SPDX-License-Identifier: Apache-2.0
// Several paths between two hosts that do not share what may fail: a flow of minimum cost over the switches.
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "scenario/topology/routing.hpp"
#include "scenario/topology/topology.hpp"

namespace takt::scenario {

struct DisjointPaths {
  /// As many as asked for, from the sender to the receiver, shorter ones first. Empty if there are not so many.
  std::vector<Path> paths;
  /// Switches, other than the first and the last, that several of the paths cross; ascending. They share no link even
  /// then.
  std::vector<std::uint32_t> shared_switches;
  /// If there are not enough: how many there are, and the links of which every path uses one.
  std::size_t found = 0;
  std::vector<std::pair<std::uint32_t, std::uint32_t>> bottleneck;
};

/// `count` paths from host to host. Node-disjoint but for the two switches to which the hosts are joined if there are
/// so many, link-disjoint otherwise. Among all choices that with the fewest links, and among these the one whose links
/// were written earlier. Hosts have one link; two hosts at one switch have no disjoint paths.
DisjointPaths disjoint_paths(const Topology& topology, std::uint32_t from, std::uint32_t to, std::size_t count);

}  // namespace takt::scenario
