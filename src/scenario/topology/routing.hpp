// The paths of streams through a topology.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <vector>

#include "scenario/topology/topology.hpp"

namespace takt::scenario {

/// Node indices from the sender to one receiver, both included.
using Path = std::vector<std::uint32_t>;

/// Shortest paths by number of links, over nodes that forward. Among equally short paths the one is taken that uses links
/// written (or generated) earlier, near the root of the search; so it is the same in every run and on every machine.
class Router {
 public:
  explicit Router(const Topology& topology) : topology_(topology) {}

  /// The path that the filtering database takes for the unicast address of `to`: for one destination all paths form a tree.
  std::optional<Path> to_host(std::uint32_t from, std::uint32_t to);
  /// The path to one receiver of a multicast: for one sender all paths form a tree.
  std::optional<Path> from_host(std::uint32_t from, std::uint32_t to);

 private:
  struct Branch {
    std::uint32_t parent = 0;
    std::uint32_t depth = 0;
  };
  using Tree = std::vector<Branch>;   // by node
  /// The shortest paths from the root to all nodes that forward.
  const Tree& tree_of(std::uint32_t root);
  std::uint32_t start_of(std::uint32_t end) const;
  std::optional<Path> between(std::uint32_t root, std::uint32_t leaf);

  const Topology& topology_;
  std::map<std::uint32_t, Tree> trees_;
};

}  // namespace takt::scenario
