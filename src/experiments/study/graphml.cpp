// SPDX-License-Identifier: Apache-2.0
// GraphML files, read by Boost.Graph.
#include <boost/graph/adjacency_list.hpp>
#include <boost/graph/graphml.hpp>
#include <cctype>
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

/// What an attribute is in each element of a name, such as the ids of nodes and the ends of edges.
std::vector<std::string> attributes_of(const std::string& text, std::string_view element, std::string_view attribute) {
  std::vector<std::string> values;
  const std::string begin = "<" + std::string(element);
  for (std::size_t at = text.find(begin); at != std::string::npos; at = text.find(begin, at + 1)) {
    const std::string_view tag = std::string_view(text).substr(at, text.find('>', at) - at);
    for (std::size_t name = tag.find(attribute, begin.size()); name != std::string_view::npos;
         name = tag.find(attribute, name + 1)) {
      const std::size_t quote = name + attribute.size() + 1;
      if (!std::isspace(static_cast<unsigned char>(tag[name - 1])) || quote >= tag.size() || tag[quote - 1] != '=')
        continue;
      values.emplace_back(tag.substr(quote + 1, tag.find(tag[quote], quote + 1) - quote - 1));
      break;
    }
  }
  return values;
}

/// The library makes a node of whatever an edge names. An end that no node has, or "".
std::string undeclared_end(const std::string& text) {
  const std::vector<std::string> ids = attributes_of(text, "node", "id");
  const std::set<std::string> declared(ids.begin(), ids.end());
  for (const char* end : {"source", "target"})
    for (const std::string& id : attributes_of(text, "edge", end))
      if (!declared.contains(id)) return id;
  return {};
}

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
    if (!node.kind.empty() && node.kind != "host" && node.kind != "switch")
      return problem = "a node of kind \"" + node.kind + "\"; expected host or switch", std::nullopt;
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
  if (const std::string end = undeclared_end(text); !end.empty())
    return problem = "an edge ends at \"" + end + "\", which is the id of no node", std::nullopt;
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
