// SPDX-License-Identifier: Apache-2.0
#include "scenario/topology/redundant_trees.hpp"

#include <algorithm>
#include <deque>
#include <iterator>
#include <map>
#include <utility>

#include "sim/check.hpp"

namespace takt::scenario {

RedundantTrees::RedundantTrees(const Topology& topology, std::uint32_t from)
    : topology_(topology), from_(from), parents_(topology.nodes.size()) {
  parents_[from] = Parents{{from, from}};
  // Blocks grow from the sender, then from each node by which the rest hangs.
  std::deque<std::uint32_t> roots{from};
  while (!roots.empty()) {
    const std::uint32_t root = roots.front();
    roots.pop_front();
    while (may_grow_from(root)) {
      grow(root);
      std::ranges::copy_if(order_, std::back_inserter(roots), [&](std::uint32_t node) { return may_grow_from(node); });
    }
  }
}

bool RedundantTrees::may_grow_from(std::uint32_t node) const {
  return std::ranges::any_of(topology_.neighbours[node],
                             [&](const Neighbour& neighbour) { return grows_to(neighbour.node); });
}

/// The block that begins with the first link of the root to a node that is in no tree yet.
void RedundantTrees::grow(std::uint32_t root) {
  order_.clear();
  const auto first = std::ranges::find_if(topology_.neighbours[root],
                                          [&](const Neighbour& neighbour) { return grows_to(neighbour.node); });
  std::vector<std::uint32_t> circle = find_ear(root, root, first->node);
  if (circle.empty()) {  // the only way there
    parents_[first->node] = Parents{{root, root}};
    order_.push_back(first->node);
    return;
  }
  insert(root, std::move(circle));
  while (add_ear(root)) {
  }
}

bool RedundantTrees::add_ear(std::uint32_t root) {
  for (const std::uint32_t node : order_) {
    for (const Neighbour& neighbour : topology_.neighbours[node]) {
      if (!grows_to(neighbour.node)) continue;
      std::vector<std::uint32_t> ear = find_ear(root, node, neighbour.node);
      if (ear.empty()) continue;
      insert(root, std::move(ear));
      return true;
    }
  }
  return false;
}

/// The shortest way from `first`, a neighbour of `from`, over nodes that are in no tree to another node of the block,
/// both ends included; a circle may end at its root, but by another link. Empty if there is none.
std::vector<std::uint32_t> RedundantTrees::find_ear(std::uint32_t root, std::uint32_t from, std::uint32_t first) const {
  const auto is_end = [&](std::uint32_t at, std::uint32_t node) {
    if (node == from) return from == root && at != first;
    return node == root || std::ranges::find(order_, node) != order_.end();
  };
  std::map<std::uint32_t, std::uint32_t> before{{first, from}};
  std::deque<std::uint32_t> open{first};
  while (!open.empty()) {
    const std::uint32_t at = open.front();
    open.pop_front();
    for (const Neighbour& neighbour : topology_.neighbours[at]) {
      if (is_end(at, neighbour.node)) {
        std::vector<std::uint32_t> ear{neighbour.node};
        for (std::uint32_t node = at; node != from; node = before.at(node)) ear.push_back(node);
        ear.push_back(from);
        std::ranges::reverse(ear);
        return ear;
      }
      if (grows_to(neighbour.node) && before.try_emplace(neighbour.node, at).second) open.push_back(neighbour.node);
    }
  }
  return {};
}

std::size_t RedundantTrees::place_of(std::uint32_t node) const {
  return static_cast<std::size_t>(std::ranges::find(order_, node) - order_.begin());
}

/// The inner nodes of the ear come right behind its earlier end. The root is earlier than all, or later than all, as it
/// is needed.
void RedundantTrees::insert(std::uint32_t root, std::vector<std::uint32_t> ear) {
  TAKT_CHECK(ear.size() >= 3, "an ear has a node of its own");
  const bool ends_earlier = ear.back() != root && ear.front() != root && place_of(ear.back()) < place_of(ear.front());
  if (ends_earlier || (ear.back() == root && ear.front() != root))
    std::ranges::reverse(ear);  // from the root, or from the earlier end
  const bool begins_at_root = ear.front() == root;
  const std::size_t at = begins_at_root ? 0 : place_of(ear.front()) + 1;
  for (std::size_t i = 1; i + 1 < ear.size(); ++i) parents_[ear[i]] = Parents{{ear[i - 1], ear[i + 1]}};
  order_.insert(order_.begin() + static_cast<std::ptrdiff_t>(at), ear.begin() + 1, ear.end() - 1);
}

Path RedundantTrees::path_in(std::size_t tree, std::uint32_t node) const {
  Path path;
  for (std::uint32_t at = node; at != from_; at = parents_[at]->of[tree]) path.push_back(at);
  path.push_back(from_);
  std::ranges::reverse(path);
  return path;
}

std::size_t shared_links(const Path& a, const Path& b) {
  std::size_t shared = 0;
  for (std::size_t i = 0; i + 1 < a.size(); ++i)
    for (std::size_t j = 0; j + 1 < b.size(); ++j)
      shared += std::minmax(a[i], a[i + 1]) == std::minmax(b[j], b[j + 1]) ? 1 : 0;
  return shared;
}

std::optional<std::array<Path, 2>> RedundantTrees::to(std::uint32_t node) const {
  if (is_in(node)) return std::array{path_in(0, node), path_in(1, node)};
  // A host: by those two of its neighbours whose ways share the least; of equally good ones the shortest, then those of
  // earlier links.
  std::optional<std::array<Path, 2>> best;
  const auto cost = [](const std::array<Path, 2>& paths) {
    return std::pair(shared_links(paths[0], paths[1]), paths[0].size() + paths[1].size());
  };
  for (const Neighbour& first : topology_.neighbours[node])
    for (const Neighbour& second : topology_.neighbours[node]) {
      if (!is_in(first.node) || !is_in(second.node)) continue;
      std::array paths{path_in(0, first.node), path_in(1, second.node)};
      for (Path& path : paths) path.push_back(node);
      if (!best || cost(paths) < cost(*best)) best = std::move(paths);
    }
  return best;
}

}  // namespace takt::scenario
