// SPDX-License-Identifier: Apache-2.0
#include "study/topologies.hpp"

#include <algorithm>
#include <filesystem>
#include <set>

#include "scenario/description/limits.hpp"
#include "scenario/topology/generators.hpp"

namespace takt::study {
namespace {

using scenario::most_nodes;

json::Node text(const std::string& value) { return json::Node::of_string(value); }

/// Hosts h1, h2 ... at the switches, in names that are still free.
void add_hosts(PlainGraph& graph, std::uint32_t per_switch) {
  std::set<std::string> taken;
  for (const PlainGraph::Node& node : graph.nodes) taken.insert(node.name);
  const std::size_t switches = graph.nodes.size();
  std::size_t number = 0;
  for (std::size_t i = 0; i < switches; ++i) {
    for (std::uint32_t k = 0; k < per_switch && !graph.nodes[i].is_host; ++k) {
      std::string name;
      do name = "h" + std::to_string(++number);
      while (!taken.insert(name).second);
      graph.links.push_back({i, graph.nodes.size(), {}, {}});
      graph.nodes.push_back({name, true});
    }
  }
}

json::Node network_of(const PlainGraph& graph, const GraphmlLevel& level) {
  json::Node nodes = json::Node::object();
  for (const PlainGraph::Node& node : graph.nodes) {
    json::Node one = json::Node::object();
    one.add("kind", text(node.is_host ? "host" : "switch"));
    if (node.is_host)
      one.add("os", text(level.os));
    else
      one.add("forwarding_delay", text(json::to_text(level.forwarding_delay)));
    nodes.add(node.name, std::move(one));
  }
  json::Node links = json::Node::array();
  for (const PlainGraph::Link& link : graph.links) {
    json::Node one = json::Node::object();
    json::Node ends = json::Node::array();
    ends.items = {text(graph.nodes[link.a].name), text(graph.nodes[link.b].name)};
    one.add("ends", std::move(ends));
    one.add("rate", text(link.rate.empty() ? json::to_text(level.rate) : link.rate));
    one.add("length", text(link.length.empty() ? json::to_text(level.length) : link.length));
    links.items.push_back(std::move(one));
  }
  json::Node network = json::Node::object();
  network.add("nodes", std::move(nodes));
  network.add("links", std::move(links));
  return network;
}

json::Node network_of(const GraphmlLevel& level, const std::string& folder, json::Diagnostics& diagnostics) {
  std::string problem;
  auto graph = read_graphml((std::filesystem::path(folder) / level.graphml).string(), problem);
  if (!graph) {
    diagnostics.error(level.where.at("graphml"), "cannot read this GraphML file: " + problem,
                      {json::quote(level.graphml)});
    return json::Node::object();
  }
  if (graph->nodes.size() * (std::uint64_t{level.hosts_per_switch} + 1) > most_nodes) {
    diagnostics.error(level.where.place(), "too many nodes", {"", "at most " + std::to_string(most_nodes)});
    return json::Node::object();
  }
  add_hosts(*graph, level.hosts_per_switch);
  return network_of(*graph, level);
}

json::Node network_of(const scenario::Generator& generator, const std::string&, json::Diagnostics& diagnostics) {
  // What is wrong with it is told here, where it is written; the scenarios that get it are not.
  scenario::generate(generator, most_nodes, diagnostics);
  json::Node generators = json::Node::array();
  generators.items.push_back(json::encode_value(generator));
  json::Node network = json::Node::object();
  network.add("generate", std::move(generators));
  return network;
}

}  // namespace

json::Node network_of(const TopologyLevel& level, const std::string& folder, json::Diagnostics& diagnostics) {
  return std::visit([&](const auto& each) { return network_of(each, folder, diagnostics); }, level.from);
}

}  // namespace takt::study
