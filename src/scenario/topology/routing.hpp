// The paths of streams through a topology.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <vector>

#include "scenario/topology/topology.hpp"

namespace takt::scenario {

/// Node indices from the sender to one receiver, both included.
using Path = std::vector<std::uint32_t>;

/// Shortest paths by number of links. Hosts do not forward. Among equally short paths the one is taken that uses links
/// written (or generated) earlier, near the root of the search; so it is the same in every run and on every machine.
class Router {
 public:
  explicit Router(const Topology& topology);
  ~Router();
  Router(const Router&) = delete;
  Router& operator=(const Router&) = delete;

  /// The path that the filtering database takes for the unicast address of `to`: for one destination all paths form a tree.
  std::optional<Path> to_host(std::uint32_t from, std::uint32_t to);
  /// The path to one receiver of a multicast: for one sender all paths form a tree.
  std::optional<Path> from_host(std::uint32_t from, std::uint32_t to);

 private:
  struct Graph;
  /// The parent of each switch in the tree of shortest paths that is rooted at this switch.
  const std::vector<std::uint32_t>& tree_of(std::uint32_t root);
  std::optional<Path> between(std::uint32_t root_host, std::uint32_t leaf_host);

  const Topology& topology_;
  std::unique_ptr<Graph> graph_;
  std::map<std::uint32_t, std::vector<std::uint32_t>> trees_;
};

}  // namespace takt::scenario
