// SPDX-License-Identifier: Apache-2.0
#include "scenario/topology/routing.hpp"

#include <algorithm>

#include "sim/check.hpp"

namespace takt::scenario {
namespace {
constexpr std::uint32_t nowhere = 0xFFFF'FFFF;
constexpr std::size_t most_tree_entries = 50'000'000;
}  // namespace

const Neighbour& step_of(const Topology& topology, const Path& path, std::size_t at) {
  const std::uint16_t port = at < path.ports.size() ? path.ports[at] : Path::first_link;
  for (const Neighbour& neighbour : topology.neighbours[path[at]])
    if (neighbour.node == path[at + 1] && (port == Path::first_link || neighbour.port == port)) return neighbour;
  TAKT_CHECK(false, "a path leads from neighbour to neighbour");
  return topology.neighbours[path[at]].front();
}

void append(const Topology& topology, Path& path, const Neighbour& next) {
  const std::size_t at = path.size() - 1;
  path.push_back(next.node);
  if (step_of(topology, path, at).port == next.port) return;
  path.ports.resize(at, Path::first_link);
  path.ports.push_back(next.port);
}

void remove_last(Path& path) {
  path.pop_back();
  if (path.ports.size() >= path.size()) path.ports.resize(path.empty() ? 0 : path.size() - 1);
  while (!path.ports.empty() && path.ports.back() == Path::first_link) path.ports.pop_back();
}

Path reversed(const Topology& topology, const Path& path) {
  Path back{path.back()};
  for (std::size_t at = path.size() - 1; at-- > 0;) {
    const Neighbour& step = step_of(topology, path, at);
    append(topology, back, {path[at], step.their_port, step.port});
  }
  return back;
}

Router::Router(const Topology& topology) : topology_(topology), spots_(topology.nodes.size(), nowhere) {
  for (std::uint32_t node = 0; node < topology.nodes.size(); ++node) {
    if (!topology.nodes[node].forwards()) continue;
    spots_[node] = static_cast<Spot>(forwarders_.size());
    forwarders_.push_back(node);
  }
  onward_.resize(forwarders_.size());
  for (Spot spot = 0; spot < forwarders_.size(); ++spot)
    for (const Neighbour& neighbour : topology.neighbours[forwarders_[spot]])
      if (spots_[neighbour.node] != nowhere) onward_[spot].push_back(spots_[neighbour.node]);
}

Router::Spot Router::spot_of(std::uint32_t node, std::uint32_t root) const {
  if (spots_[node] != nowhere) return spots_[node];
  return node == root ? static_cast<Spot>(forwarders_.size()) : nowhere;
}

const Router::Tree& Router::tree_of(std::uint32_t root) {
  // Trees are kept for the next stream with the same root, but not without bound.
  if (trees_.size() * forwarders_.size() > most_tree_entries) trees_.clear();
  auto [at, is_new] = trees_.try_emplace(root);
  Tree& tree = at->second;
  if (!is_new) return tree;
  tree.assign(forwarders_.size() + 1, {nowhere, 0});
  const Spot first = spot_of(root, root);
  tree[first] = {first, 0};
  std::vector<Spot> reached(tree.size());  // the first `count` of them
  std::size_t count = 0;
  reached[count++] = first;
  const auto reach = [&](Spot to, Spot from) {
    if (tree[to].parent != nowhere) return;
    tree[to] = {from, tree[from].depth + 1};
    reached[count++] = to;
  };
  if (first == forwarders_.size())
    for (const Neighbour& neighbour : topology_.neighbours[root])
      if (spots_[neighbour.node] != nowhere) reach(spots_[neighbour.node], first);
  for (std::size_t next = 0; next < count; ++next)
    if (reached[next] < forwarders_.size())
      for (const Spot neighbour : onward_[reached[next]]) reach(neighbour, reached[next]);
  return tree;
}

/// Where the tree for an end begins: at the end itself if it has a choice, else at its only neighbour, so that many
/// hosts share a tree.
std::uint32_t Router::start_of(std::uint32_t end) const {
  const std::vector<Neighbour>& neighbours = topology_.neighbours[end];
  const bool has_choice =
      topology_.nodes[end].forwards() || neighbours.size() != 1 || !topology_.nodes[neighbours.front().node].forwards();
  return has_choice ? end : neighbours.front().node;
}

std::optional<Path> Router::between(std::uint32_t root, std::uint32_t leaf) {
  const std::uint32_t start = start_of(root);
  const Tree& tree = tree_of(start);
  const auto is_reached = [&](Spot spot) { return spot != nowhere && tree[spot].parent != nowhere; };
  Spot last = nowhere;  // of the tree
  if (spots_[leaf] != nowhere) {
    last = spots_[leaf];
  } else {
    for (const Neighbour& neighbour : topology_.neighbours[leaf]) {
      const Spot spot = spot_of(neighbour.node, start);
      if (is_reached(spot) && (last == nowhere || tree[spot].depth < tree[last].depth)) last = spot;
    }
  }
  if (!is_reached(last)) return std::nullopt;
  Path path;
  if (spots_[leaf] == nowhere) path.push_back(leaf);
  for (Spot at = last;; at = tree[at].parent) {
    path.push_back(at < forwarders_.size() ? forwarders_[at] : start);
    if (tree[at].parent == at) break;
  }
  if (start != root) path.push_back(root);
  return path;
}

std::optional<Path> Router::to_host(std::uint32_t from, std::uint32_t to) {
  const auto known = std::ranges::lower_bound(ends_laid_, Ends{from, to});
  if (known != ends_laid_.end() && *known == Ends{from, to})
    return laid_[static_cast<std::size_t>(known - ends_laid_.begin())];
  return between(to, from);
}

void Router::lay_ahead(std::vector<Ends> wanted) {
  std::ranges::sort(wanted);
  wanted.erase(std::unique(wanted.begin(), wanted.end()), wanted.end());
  ends_laid_ = std::move(wanted);
  laid_.resize(ends_laid_.size());
  std::vector<std::pair<std::uint32_t, std::size_t>> by_root;
  for (std::size_t i = 0; i < ends_laid_.size(); ++i) by_root.push_back({start_of(ends_laid_[i].second), i});
  std::ranges::sort(by_root);
  for (const auto& [root, i] : by_root) {
    if (!trees_.contains(root)) trees_.clear();
    laid_[i] = between(ends_laid_[i].second, ends_laid_[i].first);
  }
  trees_.clear();
}

std::optional<Path> Router::from_host(std::uint32_t from, std::uint32_t to) {
  std::optional<Path> path = between(from, to);
  if (path) std::reverse(path->begin(), path->end());
  return path;
}

}  // namespace takt::scenario
