// SPDX-License-Identifier: Apache-2.0
#include "scenario/figures/graph_figures.hpp"

#include <algorithm>
#include <boost/graph/adjacency_list.hpp>
#include <boost/graph/biconnected_components.hpp>
#include <boost/graph/breadth_first_search.hpp>
#include <optional>

#include "scenario/topology/disjoint_paths.hpp"

namespace takt::scenario {
namespace {

using EdgeNumber = boost::property<boost::edge_index_t, std::size_t>;
using SwitchGraph = boost::adjacency_list<boost::vecS, boost::vecS, boost::undirectedS, boost::no_property, EdgeNumber>;

/// The switches and the links between them.
SwitchGraph switches_of(const Topology& topology) {
  std::vector<std::size_t> number(topology.nodes.size(), 0);
  std::size_t count = 0;
  for (std::size_t i = 0; i < topology.nodes.size(); ++i)
    if (topology.nodes[i].forwards()) number[i] = count++;
  SwitchGraph graph(count);
  for (std::uint32_t a = 0; a < topology.nodes.size(); ++a)
    for (const Neighbour& neighbour : topology.neighbours[a])
      if (neighbour.node > a && topology.nodes[a].forwards() && topology.nodes[neighbour.node].forwards())
        boost::add_edge(number[a], number[neighbour.node], boost::num_edges(graph), graph);
  return graph;
}

/// Links on the longest shortest path; nothing if the graph is in parts or empty.
std::optional<std::size_t> diameter_of(const SwitchGraph& graph) {
  const std::size_t n = boost::num_vertices(graph);
  std::size_t diameter = 0;
  for (std::size_t from = 0; from < n; ++from) {
    std::vector<std::size_t> distance(n, n);
    distance[from] = 0;
    boost::breadth_first_search(
        graph, boost::vertex(from, graph),
        boost::visitor(boost::make_bfs_visitor(boost::record_distances(distance.data(), boost::on_tree_edge()))));
    const std::size_t farthest = *std::max_element(distance.begin(), distance.end());
    if (farthest == n) return std::nullopt;
    diameter = std::max(diameter, farthest);
  }
  return n == 0 ? std::nullopt : std::optional(diameter);
}

/// Links that are a biconnected component of their own.
std::size_t bridges_of(const SwitchGraph& graph) {
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
      if (!master || !slave || topology.neighbours[*master].front().node == topology.neighbours[*slave].front().node)
        continue;
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

}  // namespace

const json::Record& describe(json::Type<GraphFigures>) {
  static constexpr json::Output outputs[] = {
      json::output<&GraphFigures::switches>("switches", "Switches."),
      json::output<&GraphFigures::links>("links", "Links between them."),
      json::output<&GraphFigures::diameter>(
          "diameter", "Links on the longest of the shortest paths between switches; null if some are not joined."),
      json::output<&GraphFigures::bridges>("bridges", "Links between switches whose failure parts the network."),
      json::output<&GraphFigures::disjoint_paths>(
          "disjoint_paths",
          "The fewest node-disjoint paths between the switches of a Program's master and of a slave; null without "
          "Programs or if both hang at one switch."),
  };
  static constexpr json::Record record{"topology", "The graph of switches.", outputs};
  return record;
}

GraphFigures graph_figures_of(const Resolved& resolved) {
  const SwitchGraph graph = switches_of(resolved.topology);
  return {boost::num_vertices(graph), boost::num_edges(graph), diameter_of(graph), bridges_of(graph),
          disjoint_paths_of(resolved)};
}

json::Node topology_node(const Resolved& resolved) {
  return json::ShapeOf<GraphFigures>::write(graph_figures_of(resolved));
}

}  // namespace takt::scenario
