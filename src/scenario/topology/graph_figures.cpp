#include "scenario/topology/graph_figures.hpp"

#include <algorithm>
#include <boost/graph/adjacency_list.hpp>
#include <boost/graph/biconnected_components.hpp>
#include <boost/graph/breadth_first_search.hpp>
#include <optional>

#include "scenario/topology/disjoint_paths.hpp"

namespace takt::scenario {
namespace {

using EdgeNumber = boost::property<boost::edge_index_t, std::size_t>;
using Graph = boost::adjacency_list<boost::vecS, boost::vecS, boost::undirectedS, boost::no_property, EdgeNumber>;

/// The switches and the links between them.
Graph switches_of(const Topology& topology) {
  std::vector<std::size_t> number(topology.nodes.size(), 0);
  std::size_t count = 0;
  for (std::size_t i = 0; i < topology.nodes.size(); ++i)
    if (!topology.nodes[i].is_host()) number[i] = count++;
  Graph graph(count);
  for (std::uint32_t a = 0; a < topology.nodes.size(); ++a)
    for (const Neighbour& neighbour : topology.neighbours[a])
      if (neighbour.node > a && !topology.nodes[a].is_host() && !topology.nodes[neighbour.node].is_host())
        boost::add_edge(number[a], number[neighbour.node], boost::num_edges(graph), graph);
  return graph;
}

/// Links on the longest shortest path; nothing if the graph is in parts or empty.
std::optional<std::size_t> diameter_of(const Graph& graph) {
  const std::size_t n = boost::num_vertices(graph);
  std::size_t diameter = 0;
  for (std::size_t from = 0; from < n; ++from) {
    std::vector<std::size_t> distance(n, n);
    distance[from] = 0;
    boost::breadth_first_search(graph, boost::vertex(from, graph), boost::visitor(boost::make_bfs_visitor(boost::record_distances(distance.data(), boost::on_tree_edge()))));
    const std::size_t farthest = *std::max_element(distance.begin(), distance.end());
    if (farthest == n) return std::nullopt;
    diameter = std::max(diameter, farthest);
  }
  return n == 0 ? std::nullopt : std::optional(diameter);
}

/// Links that are a biconnected component of their own.
std::size_t bridges_of(const Graph& graph) {
  std::vector<std::size_t> component(boost::num_edges(graph));
  const auto by_edge = boost::make_iterator_property_map(component.begin(), boost::get(boost::edge_index, graph));
  const std::size_t count = boost::biconnected_components(graph, by_edge);
  std::vector<std::size_t> size(count, 0);
  for (const std::size_t c : component) ++size[c];
  return static_cast<std::size_t>(std::count(size.begin(), size.end(), 1u));
}

std::optional<std::size_t> disjoint_paths_of(const Resolved& resolved) {
  std::optional<std::size_t> fewest;
  const Topology& topology = resolved.topology;
  for (const Program& program : resolved.scenario.programs) {
    const auto master = topology.find(program.master);
    for (const std::string& name : program.slaves) {
      const auto slave = topology.find(name);
      if (!master || !slave || topology.neighbours[*master].front().node == topology.neighbours[*slave].front().node) continue;
      std::size_t count = 1;
      // As many as there are without a common switch; links alone are not disjoint enough for a switch that fails.
      for (std::size_t wanted = 2; wanted <= 8; ++wanted) {
        const DisjointPaths paths = disjoint_paths(topology, *master, *slave, wanted);
        if (paths.paths.size() < wanted || !paths.shared_switches.empty()) break;
        count = wanted;
      }
      fewest = std::min(fewest.value_or(count), count);
    }
  }
  return fewest;
}

json::Node integer(std::size_t value) { return json::Node::of_integer(static_cast<sim::int128>(value)); }
json::Node integer(const std::optional<std::size_t>& value) { return value ? integer(*value) : json::Node(); }

}  // namespace

json::Node topology_node(const Resolved& resolved) {
  const Graph graph = switches_of(resolved.topology);
  json::Node node = json::Node::object();
  node.add("switches", integer(boost::num_vertices(graph)));
  node.add("links", integer(boost::num_edges(graph)));
  node.add("diameter", integer(diameter_of(graph)));
  node.add("bridges", integer(bridges_of(graph)));
  node.add("disjoint_paths", integer(disjoint_paths_of(resolved)));
  return node;
}

}  // namespace takt::scenario
