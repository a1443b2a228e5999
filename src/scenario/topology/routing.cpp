#include "scenario/topology/routing.hpp"

#include <algorithm>
#include <boost/graph/adjacency_list.hpp>
#include <boost/graph/breadth_first_search.hpp>

namespace takt::scenario {
namespace {
constexpr std::uint32_t nowhere = 0xFFFF'FFFF;
constexpr std::size_t most_tree_entries = 50'000'000;
}

// Only the switches are vertices; the edges of a vertex stand in the order of the links.
struct Router::Graph {
  using List = boost::adjacency_list<boost::vecS, boost::vecS, boost::undirectedS>;
  List list;
  std::vector<std::uint32_t> vertex_of_node;
  std::vector<std::uint32_t> node_of_vertex;
};

Router::Router(const Topology& topology) : topology_(topology), graph_(std::make_unique<Graph>()) {
  graph_->vertex_of_node.assign(topology.nodes.size(), nowhere);
  for (std::uint32_t n = 0; n < topology.nodes.size(); ++n) {
    if (topology.nodes[n].is_host()) continue;
    graph_->vertex_of_node[n] = static_cast<std::uint32_t>(graph_->node_of_vertex.size());
    graph_->node_of_vertex.push_back(n);
  }
  graph_->list = Graph::List(graph_->node_of_vertex.size());
  for (const models::LinkPlan& link : topology.links) {
    const std::uint32_t a = graph_->vertex_of_node[link.a.node.value];
    const std::uint32_t b = graph_->vertex_of_node[link.b.node.value];
    if (a != nowhere && b != nowhere) boost::add_edge(a, b, graph_->list);
  }
}

Router::~Router() = default;

const std::vector<std::uint32_t>& Router::tree_of(std::uint32_t root) {
  // Trees are kept for the next stream with the same root, but not without bound.
  if (trees_.size() * graph_->node_of_vertex.size() > most_tree_entries) trees_.clear();
  auto [at, is_new] = trees_.try_emplace(root);
  std::vector<std::uint32_t>& parents = at->second;
  if (!is_new) return parents;
  parents.assign(graph_->node_of_vertex.size(), nowhere);
  parents[root] = root;
  boost::breadth_first_search(graph_->list, root,
                              boost::visitor(boost::make_bfs_visitor(boost::record_predecessors(parents.data(), boost::on_tree_edge()))));
  return parents;
}

std::optional<Path> Router::between(std::uint32_t root_host, std::uint32_t leaf_host) {
  if (topology_.neighbours[root_host].empty() || topology_.neighbours[leaf_host].empty()) return std::nullopt;
  const std::uint32_t root_neighbour = topology_.neighbours[root_host].front().node;
  const std::uint32_t leaf_neighbour = topology_.neighbours[leaf_host].front().node;
  if (root_neighbour == leaf_host) return Path{leaf_host, root_host};
  const std::uint32_t root = graph_->vertex_of_node[root_neighbour];
  const std::uint32_t leaf = graph_->vertex_of_node[leaf_neighbour];
  if (root == nowhere || leaf == nowhere) return std::nullopt;
  const std::vector<std::uint32_t>& parents = tree_of(root);
  if (parents[leaf] == nowhere) return std::nullopt;
  Path path{leaf_host};
  for (std::uint32_t at = leaf;; at = parents[at]) {
    path.push_back(graph_->node_of_vertex[at]);
    if (at == root) break;
  }
  path.push_back(root_host);
  return path;
}

std::optional<Path> Router::to_host(std::uint32_t from, std::uint32_t to) { return between(to, from); }

std::optional<Path> Router::from_host(std::uint32_t from, std::uint32_t to) {
  std::optional<Path> path = between(from, to);
  if (path) std::reverse(path->begin(), path->end());
  return path;
}

}  // namespace takt::scenario
