#include "scenario/topology/routing.hpp"

#include <algorithm>

namespace takt::scenario {
namespace {
constexpr std::uint32_t nowhere = 0xFFFF'FFFF;
constexpr std::size_t most_tree_entries = 50'000'000;
}

const Router::Tree& Router::tree_of(std::uint32_t root) {
  // Trees are kept for the next stream with the same root, but not without bound.
  if (trees_.size() * topology_.nodes.size() > most_tree_entries) trees_.clear();
  auto [at, is_new] = trees_.try_emplace(root);
  Tree& tree = at->second;
  if (!is_new) return tree;
  tree.assign(topology_.nodes.size(), {nowhere, 0});
  tree[root] = {root, 0};
  std::vector<std::uint32_t> reached{root};
  for (std::size_t next = 0; next < reached.size(); ++next) {
    const std::uint32_t node = reached[next];
    for (const Neighbour& neighbour : topology_.neighbours[node]) {
      if (tree[neighbour.node].parent != nowhere || !topology_.nodes[neighbour.node].forwards()) continue;
      tree[neighbour.node] = {node, tree[node].depth + 1};
      reached.push_back(neighbour.node);
    }
  }
  return tree;
}

/// Where the tree for an end begins: at the end itself if it has a choice, else at its only neighbour, so that many hosts share a tree.
std::uint32_t Router::start_of(std::uint32_t end) const {
  const std::vector<Neighbour>& neighbours = topology_.neighbours[end];
  const bool has_choice = topology_.nodes[end].forwards() || neighbours.size() != 1 || !topology_.nodes[neighbours.front().node].forwards();
  return has_choice ? end : neighbours.front().node;
}

std::optional<Path> Router::between(std::uint32_t root, std::uint32_t leaf) {
  const std::uint32_t start = start_of(root);
  const Tree& tree = tree_of(start);
  std::uint32_t last = nowhere;   // of the tree
  if (topology_.nodes[leaf].forwards()) {
    last = leaf;
  } else {
    for (const Neighbour& neighbour : topology_.neighbours[leaf])
      if (tree[neighbour.node].parent != nowhere && (last == nowhere || tree[neighbour.node].depth < tree[last].depth)) last = neighbour.node;
  }
  if (last == nowhere || tree[last].parent == nowhere) return std::nullopt;
  Path path;
  if (last != leaf) path.push_back(leaf);
  for (std::uint32_t at = last;; at = tree[at].parent) {
    path.push_back(at);
    if (at == start) break;
  }
  if (start != root) path.push_back(root);
  return path;
}

std::optional<Path> Router::to_host(std::uint32_t from, std::uint32_t to) { return between(to, from); }

std::optional<Path> Router::from_host(std::uint32_t from, std::uint32_t to) {
  std::optional<Path> path = between(from, to);
  if (path) std::reverse(path->begin(), path->end());
  return path;
}

}  // namespace takt::scenario
