// GraphML files, read by Boost.Graph.
#include <boost/graph/adjacency_list.hpp>
#include <boost/graph/graphml.hpp>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <set>
#include <sstream>

#include "study/topologies.hpp"

namespace takt::study {
namespace {

constexpr std::uintmax_t largest_file = std::uintmax_t{16} << 20;

struct GraphNode {
  std::string name;
  std::string kind;
};
struct GraphEdge {
  std::string rate;
  std::string length;
};
template <class Directed>
using GraphOf = boost::adjacency_list<boost::vecS, boost::vecS, Directed, GraphNode, GraphEdge>;

template <class Graph>
Graph read_as(const std::string& text) {
  Graph graph;
  boost::dynamic_properties properties(boost::ignore_other_properties);
  properties.property("name", boost::get(&GraphNode::name, graph));
  properties.property("kind", boost::get(&GraphNode::kind, graph));
  properties.property("rate", boost::get(&GraphEdge::rate, graph));
  properties.property("length", boost::get(&GraphEdge::length, graph));
  std::istringstream stream(text);
  boost::read_graphml(stream, graph, properties);
  return graph;
}

template <class Graph>
std::optional<PlainGraph> plain_of(const Graph& graph, std::string& problem) {
  PlainGraph plain;
  std::set<std::string> names;
  for (const auto vertex : boost::make_iterator_range(boost::vertices(graph))) {
    const GraphNode& node = graph[vertex];
    if (!node.kind.empty() && node.kind != "host" && node.kind != "switch") return problem = "a node of kind \"" + node.kind + "\"; expected host or switch", std::nullopt;
    const bool is_host = node.kind == "host";
    const std::string name = node.name.empty() ? (is_host ? "host" : "sw") + std::to_string(vertex + 1) : node.name;
    if (!names.insert(name).second) return problem = "two nodes of the name \"" + name + "\"", std::nullopt;
    plain.nodes.push_back({name, is_host});
  }
  // Two directed edges between two nodes, as some tools write, are one cable.
  std::set<std::pair<std::size_t, std::size_t>> seen;
  for (const auto edge : boost::make_iterator_range(boost::edges(graph))) {
    const std::size_t a = boost::source(edge, graph);
    const std::size_t b = boost::target(edge, graph);
    if (a == b) return problem = "a link from \"" + plain.nodes[a].name + "\" to itself", std::nullopt;
    if (!seen.contains({b, a})) plain.links.push_back({a, b, graph[edge].rate, graph[edge].length});
    seen.insert({a, b});
  }
  if (plain.nodes.empty()) return problem = "it has no nodes", std::nullopt;
  return plain;
}

}  // namespace

std::optional<PlainGraph> read_graphml(const std::string& path, std::string& problem) {
  std::error_code error;
  const std::uintmax_t size = std::filesystem::file_size(path, error);
  std::ifstream file(path);
  if (error || !file) return problem = "it cannot be opened", std::nullopt;
  if (size > largest_file) return problem = "it is larger than 16 MiB", std::nullopt;
  const std::string text((std::istreambuf_iterator<char>(file)), std::istreambuf_iterator<char>());
  try {
    // The library reads a file only into a graph of its kind.
    try {
      return plain_of(read_as<GraphOf<boost::undirectedS>>(text), problem);
    } catch (const boost::directed_graph_error&) {
      return plain_of(read_as<GraphOf<boost::bidirectionalS>>(text), problem);
    }
  } catch (const std::exception& mistake) {
    return problem = mistake.what(), std::nullopt;
  }
}

}  // namespace takt::study
