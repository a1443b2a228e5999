#include "study/topologies.hpp"

#include <algorithm>
#include <filesystem>
#include <set>

#include "sim/random.hpp"

namespace takt::study {
namespace {

constexpr std::size_t most_nodes = 100'000;

class Builder {
 public:
  Builder(const TopologyLevel& level, json::Diagnostics& diagnostics) : level_(level), diagnostics_(diagnostics) {}

  PlainGraph shape() {
    const bool is_comb = level_.shape == Shape::comb;
    const bool is_random = level_.shape == Shape::random;
    need(level_.switches.has_value(), true, "switches");
    need(level_.teeth.has_value(), is_comb, "teeth");
    need(level_.degree.has_value(), is_random, "degree");
    if (failed_) return {};
    switch (*level_.shape) {
      case Shape::comb: comb(); break;
      case Shape::random: random(); break;
      case Shape::dual_star: dual_star(); break;
    }
    return std::move(graph_);
  }

 private:
  void need(bool is_there, bool is_wanted, const char* key) {
    if (is_there == is_wanted) return;
    failed_ = true;
    if (is_wanted) diagnostics_.error(level_.where.place(), "missing key for this topology", {"none", json::quote(key)});
    else diagnostics_.error(level_.where.at(key), "this topology has no such parameter", {json::quote(key)});
  }

  std::size_t add_switch(bool takes_hosts = true) {
    graph_.nodes.push_back({"sw" + std::to_string(graph_.nodes.size() + 1), false, takes_hosts});
    return graph_.nodes.size() - 1;
  }
  void join(std::size_t a, std::size_t b) { graph_.links.push_back({a, b, {}, {}}); }

  void comb() {
    if (std::uint64_t{*level_.switches} * (*level_.teeth + 1) > most_nodes)
      return diagnostics_.error(level_.where.place(), "too many nodes", {"", "at most " + std::to_string(most_nodes)});
    std::vector<std::size_t> ends;
    for (std::uint32_t i = 0; i < *level_.switches; ++i) {
      ends.push_back(add_switch());
      if (i > 0) join(ends[i - 1], ends[i]);
    }
    for (std::size_t& end : ends)
      for (std::uint32_t t = 0; t < *level_.teeth; ++t) {
        const std::size_t next = add_switch();
        join(end, next);
        end = next;
      }
  }

  void dual_star() {
    const std::size_t cores[] = {add_switch(false), add_switch(false)};
    for (std::uint32_t i = 0; i < *level_.switches; ++i) {
      const std::size_t leaf = add_switch();
      for (const std::size_t core : cores) join(core, leaf);
    }
  }

  /// A random tree, so that it is connected, and random links until the mean degree is reached (rounded to whole links).
  void random() {
    const std::uint64_t n = *level_.switches;
    const auto wanted = static_cast<std::uint64_t>(*level_.degree * static_cast<double>(n) / 2 + 0.5);
    if (n > 1 && (wanted + 1 < n || wanted > n * (n - 1) / 2)) {
      diagnostics_.error(level_.where.at("degree"), "no connected graph has this degree",
                         {std::to_string(wanted) + " links between " + std::to_string(n) + " switches", std::to_string(n - 1) + " to " + std::to_string(n * (n - 1) / 2) + " links"});
      return;
    }
    sim::RandomStream chance(level_.seed, "network", "topology");
    std::set<std::pair<std::uint64_t, std::uint64_t>> links;
    for (std::uint64_t i = 0; i < n; ++i) {
      add_switch();
      if (i > 0) links.emplace(chance.below(i), i);
    }
    while (links.size() < wanted) {
      const std::uint64_t a = chance.below(n);
      const std::uint64_t b = chance.below(n);
      if (a != b) links.emplace(std::min(a, b), std::max(a, b));
    }
    for (const auto& [a, b] : links) join(a, b);
  }

  const TopologyLevel& level_;
  json::Diagnostics& diagnostics_;
  PlainGraph graph_;
  bool failed_ = false;
};

json::Node text(const std::string& value) { return json::Node::of_string(value); }

/// Hosts h1, h2 ... at the switches, in names that are still free.
void add_hosts(PlainGraph& graph, std::uint32_t per_switch) {
  std::set<std::string> taken;
  for (const PlainGraph::Node& node : graph.nodes) taken.insert(node.name);
  const std::size_t switches = graph.nodes.size();
  std::size_t number = 0;
  for (std::size_t i = 0; i < switches; ++i) {
    for (std::uint32_t k = 0; k < per_switch && !graph.nodes[i].is_host && graph.nodes[i].takes_hosts; ++k) {
      std::string name;
      do name = "h" + std::to_string(++number);
      while (!taken.insert(name).second);
      graph.links.push_back({i, graph.nodes.size(), {}, {}});
      graph.nodes.push_back({name, true, false});
    }
  }
}

json::Node network_of(const PlainGraph& graph, const TopologyLevel& level) {
  json::Node nodes = json::Node::object();
  for (const PlainGraph::Node& node : graph.nodes) {
    json::Node one = json::Node::object();
    one.add("kind", text(node.is_host ? "host" : "switch"));
    if (node.is_host) one.add("os", text(level.os));
    else one.add("forwarding_delay", text(json::to_text(level.forwarding_delay)));
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

}  // namespace

json::Node network_of(const TopologyLevel& level, const std::string& folder, json::Diagnostics& diagnostics) {
  const std::size_t errors_before = diagnostics.errors();
  PlainGraph graph;
  if (level.graphml) {
    for (const char* const key : {"switches", "teeth", "degree", "seed"})
      if (level.where.has(key)) diagnostics.error(level.where.at(key), "does not belong to a GraphML file", {json::quote(key)});
    std::string problem;
    auto read = read_graphml((std::filesystem::path(folder) / *level.graphml).string(), problem);
    if (!read) diagnostics.error(level.where.at("graphml"), "cannot read this GraphML file: " + problem, {json::quote(*level.graphml)});
    else graph = std::move(*read);
  } else if (level.shape) {
    graph = Builder(level, diagnostics).shape();
  }
  if (diagnostics.errors() == errors_before && graph.nodes.size() * (std::uint64_t{level.hosts_per_switch} + 1) > most_nodes)
    diagnostics.error(level.where.place(), "too many nodes", {"", "at most " + std::to_string(most_nodes)});
  if (diagnostics.errors() != errors_before) return json::Node::object();
  add_hosts(graph, level.hosts_per_switch);
  return network_of(graph, level);
}

}  // namespace takt::study
