// SPDX-License-Identifier: Apache-2.0
#include "scenario/topology/disjoint_paths.hpp"

#include <algorithm>
#include <boost/graph/adjacency_list.hpp>
#include <boost/graph/successive_shortest_path_nonnegative_weights.hpp>
#include <map>

namespace takt::scenario {
namespace {

using Traits = boost::adjacency_list_traits<boost::vecS, boost::vecS, boost::directedS>;
// Boost adds the distances of vertices that no path reaches, each the greatest of its type, which an integer cannot
// hold. The costs are whole numbers below 2^53, so that a double adds them exactly.
using Cost = double;
using Properties = boost::property<boost::edge_capacity_t, std::int64_t,
                                   boost::property<boost::edge_residual_capacity_t, std::int64_t,
                                                   boost::property<boost::edge_reverse_t, Traits::edge_descriptor,
                                                                   boost::property<boost::edge_weight_t, Cost>>>>;
using DirectedGraph = boost::adjacency_list<boost::vecS, boost::vecS, boost::directedS, boost::no_property, Properties>;

/// Each switch is two vertices, where paths come in and where they go out, with the number of paths that may cross it
/// between.
class FlowNetwork {
 public:
  FlowNetwork(const Topology& topology, std::uint32_t from, std::uint32_t to, std::int64_t count,
              std::int64_t count_at_switch)
      : graph_(2 * topology.nodes.size() + 2), from_(from) {
    const std::size_t source = 2 * topology.nodes.size();
    const std::size_t sink = source + 1;
    const auto is_end = [&](std::uint32_t n) { return n == from || n == to; };
    // A host with one link sends and receives all copies over it; one with several links gives each path one of its
    // own.
    const auto is_only_way = [&](std::uint32_t host, std::uint32_t n) {
      return topology.neighbours[host].size() == 1 && topology.neighbours[host].front().node == n;
    };
    for (std::uint32_t n = 0; n < topology.nodes.size(); ++n)
      if (topology.nodes[n].forwards() || is_end(n))
        add(way_in(n), way_out(n), is_end(n) || is_only_way(from, n) || is_only_way(to, n) ? count : count_at_switch,
            0);
    // One link more costs more than any choice among equally many.
    const Cost cost_of_link = static_cast<Cost>(topology.nodes.size()) * static_cast<Cost>(topology.links.size()) + 1;
    Cost number = 0;
    for (const models::LinkPlan& link : topology.links) {
      const std::uint32_t a = link.a.node.value;
      const std::uint32_t b = link.b.node.value;
      number += 1;
      if ((!topology.nodes[a].forwards() && !is_end(a)) || (!topology.nodes[b].forwards() && !is_end(b))) continue;
      for (const auto& [x, y] : {std::pair(&link.a, &link.b), std::pair(&link.b, &link.a)}) {
        const std::uint32_t at = x->node.value, next = y->node.value;
        if (next == from || at == to) continue;
        const bool for_all = (at == from && is_only_way(from, next)) || (next == to && is_only_way(to, at));
        links_.push_back({at,
                          {next, x->port, y->port},
                          for_all,
                          add(way_out(at), way_in(next), for_all ? count : 1, cost_of_link + number)});
      }
    }
    const Traits::edge_descriptor all = add(source, way_in(from), count, 0);
    add(way_out(to), sink, count, 0);
    boost::successive_shortest_path_nonnegative_weights(graph_, source, sink);
    flow_ = static_cast<std::size_t>(count - residual(all));
  }

  std::size_t flow() const { return flow_; }

  /// The flow as paths.
  std::vector<Path> paths(const Topology& topology) const {
    std::map<std::uint32_t, std::vector<Neighbour>> next;
    for (const Link& link : links_)
      for (std::int64_t left = (link.for_all ? static_cast<std::int64_t>(flow_) : 1) - residual_of(link); left > 0;
           --left)
        next[link.from].push_back(link.to);
    std::vector<Path> paths(flow_, Path{from_});
    for (Path& path : paths) {
      for (auto at = next.find(from_); at != next.end() && !at->second.empty(); at = next.find(path.back())) {
        append(topology, path, at->second.back());
        at->second.pop_back();
      }
    }
    std::sort(paths.begin(), paths.end(),
              [](const Path& a, const Path& b) { return a.size() != b.size() ? a.size() < b.size() : a < b; });
    return paths;
  }

  /// A minimum cut: full links from what the flow could still reach to what it could not.
  std::vector<std::pair<std::uint32_t, std::uint32_t>> cut() const {
    std::vector<bool> reached(boost::num_vertices(graph_), false);
    std::vector<std::size_t> open{way_in(from_)};
    reached[way_in(from_)] = true;
    while (!open.empty()) {
      const std::size_t vertex = open.back();
      open.pop_back();
      for (auto [edge, end] = boost::out_edges(vertex, graph_); edge != end; ++edge) {
        const std::size_t to = boost::target(*edge, graph_);
        if (residual(*edge) == 0 || reached[to]) continue;
        reached[to] = true;
        open.push_back(to);
      }
    }
    std::vector<std::pair<std::uint32_t, std::uint32_t>> found;
    for (const Link& link : links_)
      if (reached[way_out(link.from)] && !reached[way_in(link.to.node)]) found.emplace_back(link.from, link.to.node);
    return found;
  }

 private:
  struct Link {
    std::uint32_t from = 0;
    Neighbour to;
    bool for_all = false;  // carries all paths
    Traits::edge_descriptor edge;
  };

  static std::size_t way_in(std::uint32_t node) { return std::size_t{2} * node; }
  static std::size_t way_out(std::uint32_t node) { return std::size_t{2} * node + 1; }

  Traits::edge_descriptor add(std::size_t from, std::size_t to, std::int64_t capacity, Cost cost) {
    const auto forth = boost::add_edge(from, to, graph_).first;
    const auto back = boost::add_edge(to, from, graph_).first;
    boost::put(boost::edge_capacity, graph_, forth, capacity);
    boost::put(boost::edge_capacity, graph_, back, 0);
    boost::put(boost::edge_weight, graph_, forth, cost);
    boost::put(boost::edge_weight, graph_, back, -cost);
    boost::put(boost::edge_reverse, graph_, forth, back);
    boost::put(boost::edge_reverse, graph_, back, forth);
    return forth;
  }
  /// Only meaningful if all of the flow that was asked for has been found.
  std::int64_t residual_of(const Link& link) const { return residual(link.edge); }
  std::int64_t residual(Traits::edge_descriptor edge) const {
    return boost::get(boost::edge_residual_capacity, graph_, edge);
  }

  DirectedGraph graph_;
  std::vector<Link> links_;
  std::uint32_t from_;
  std::size_t flow_ = 0;
};

/// Switches that several paths cross between where they part and where they meet for good.
std::vector<std::uint32_t> shared_switches(const std::vector<Path>& paths) {
  std::map<std::uint32_t, std::size_t> crossed;
  for (const Path& path : paths)
    for (std::size_t i = 1; i + 1 < path.size(); ++i) ++crossed[path[i]];
  std::vector<std::uint32_t> shared;
  for (const auto& [node, times] : crossed) {
    const auto is_at = [n = node](std::size_t from_front, std::size_t from_back) {
      return [=](const Path& path) { return path[from_front] == n || path[path.size() - 1 - from_back] == n; };
    };
    if (times > 1 && !std::all_of(paths.begin(), paths.end(), is_at(1, 1))) shared.push_back(node);
  }
  return shared;
}

}  // namespace

DisjointPaths disjoint_paths(const Topology& topology, std::uint32_t from, std::uint32_t to, std::size_t count) {
  DisjointPaths result;
  const std::vector<Neighbour>& first = topology.neighbours[from];
  const std::vector<Neighbour>& last = topology.neighbours[to];
  if (first.empty() || last.empty()) return result;
  const bool meet_at_once = first.size() == 1 && last.size() == 1 && first.front().node == last.front().node;
  const bool is_only_link =
      (first.size() == 1 && first.front().node == to) || (last.size() == 1 && last.front().node == from);
  if (meet_at_once || is_only_link) {
    result.found = 1;
    return result;
  }
  const auto wanted = static_cast<std::int64_t>(count);
  for (const std::int64_t count_at_switch : {std::int64_t{1}, wanted}) {
    const FlowNetwork network(topology, from, to, wanted, count_at_switch);
    result.found = network.flow();
    if (network.flow() < count) {
      result.bottleneck = network.cut();
      continue;
    }
    result.paths = network.paths(topology);
    result.shared_switches = shared_switches(result.paths);
    result.bottleneck.clear();
    break;
  }
  return result;
}

}  // namespace takt::scenario
