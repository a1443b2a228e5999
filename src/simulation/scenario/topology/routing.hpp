// SPDX-License-Identifier: Apache-2.0
// The paths of streams through a topology.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "scenario/topology/topology.hpp"

namespace takt::scenario {

/// Node indices from the sender to one receiver, both included; between neighbours that several links join the first
/// link, unless it says another.
struct Path : std::vector<std::uint32_t> {
  using std::vector<std::uint32_t>::vector;
  static constexpr std::uint16_t first_link = 0xFFFF;
  /// By position: the port by which the path leaves that node. Of the nodes behind it is that of the first link.
  std::vector<std::uint16_t> ports;

  bool operator==(const Path&) const = default;
  auto operator<=>(const Path&) const = default;
};

/// Goes on to a neighbour by that link.
void append(const Topology& topology, Path& path, const Neighbour& next);
void remove_last(Path& path);
Path reversed(const Topology& topology, const Path& path);

/// The link from the node at that position to the next one.
const Neighbour& step_of(const Topology& topology, const Path& path, std::size_t at);
/// The port by which the path leaves the node at that position.
inline std::uint16_t port_out(const Topology& topology, const Path& path, std::size_t at) {
  return step_of(topology, path, at).port;
}
/// The port by which it comes to the node at that position, which is not the first.
inline std::uint16_t port_in(const Topology& topology, const Path& path, std::size_t at) {
  return step_of(topology, path, at - 1).their_port;
}

/// Shortest paths by number of links, over nodes that forward. Among equally short paths the one is taken that uses
/// links written (or generated) earlier, near the root of the search; so it is the same in every run and on every
/// machine.
class Router {
 public:
  /// The topology has to stay as it is.
  explicit Router(const Topology& topology);

  /// Sender and receiver of a unicast path.
  using Ends = std::pair<std::uint32_t, std::uint32_t>;
  /// Lays the paths that to_host() will be asked for, destination by destination: so each tree is made once, and one at
  /// a time. In any other order a large plant needs more trees than fit into memory.
  void lay_ahead(std::vector<Ends> wanted);

  /// The path that the filtering database takes for the unicast address of `to`: for one destination all paths form a
  /// tree.
  std::optional<Path> to_host(std::uint32_t from, std::uint32_t to);
  /// The path to one receiver of a multicast: for one sender all paths form a tree.
  std::optional<Path> from_host(std::uint32_t from, std::uint32_t to);

 private:
  /// Where a node is in a tree: those that forward are numbered on their own, since most nodes of a plant are ends;
  /// behind them is the root, if it is an end.
  using Spot = std::uint32_t;
  struct Branch {
    Spot parent = 0;
    std::uint32_t depth = 0;
  };
  using Tree = std::vector<Branch>;  // by spot
  /// The shortest paths from the root to all nodes that forward.
  const Tree& tree_of(std::uint32_t root);
  Spot spot_of(std::uint32_t node, std::uint32_t root) const;
  std::uint32_t start_of(std::uint32_t end) const;
  std::optional<Path> between(std::uint32_t root, std::uint32_t leaf);

  const Topology& topology_;
  std::vector<Spot> spots_;                // by node; nowhere: an end
  std::vector<std::uint32_t> forwarders_;  // by spot
  std::vector<std::vector<Spot>> onward_;  // by spot: neighbours that forward, in the order of the links
  std::map<std::uint32_t, Tree> trees_;
  std::vector<Ends> ends_laid_;            // in order
  std::vector<std::optional<Path>> laid_;  // by their places in ends_laid_
};

}  // namespace takt::scenario
