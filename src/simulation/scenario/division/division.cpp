// SPDX-License-Identifier: Apache-2.0
#include "scenario/division/division.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <utility>

#include "json/quantity.hpp"
#include "models/ethernet/sizes.hpp"
#include "scenario/division/bisection.hpp"
#include "scenario/division/blocks.hpp"
#include "sim/random.hpp"

namespace takt::scenario {
namespace {

/// A part that has less to do until its neighbours must be heard would wait for most of its time.
constexpr double least_frame_hops_a_promise = 16;
/// The part with most to do may have so much of all, times the number of parts.
constexpr double greatest_imbalance = 1.5;

using Crossing = std::map<std::pair<std::uint32_t, std::uint32_t>, double>;  // frames a second from node to node

Crossing frames_between_nodes(const Resolved& resolved) {
  Crossing frames;
  for (const ResolvedStream& stream : resolved.streams) {
    Crossing once;  // a multicast crosses a link once
    for (const Path& path : stream.paths)
      for (std::size_t i = 1; i < path.size(); ++i) once[{path[i - 1], path[i]}] = stream.demand.frames_per_second;
    for (const auto& [link, rate] : once) frames[link] += rate;
  }
  return frames;
}

class Divider {
 public:
  explicit Divider(const Resolved& resolved)
      : resolved_(resolved), blocks_(blocks_of(resolved)), frames_(frames_between_nodes(resolved)) {}

  std::uint32_t blocks() const { return blocks_.count; }

  Division by_graph(std::uint32_t parts) const {
    std::vector<std::uint32_t> part_of_block(blocks_.count, 0);
    std::vector<std::uint32_t> all(blocks_.count);
    std::iota(all.begin(), all.end(), 0u);
    split(whole_graph(), all, parts, 0, part_of_block);
    return made_of(parts, part_of_block);
  }

  Division at_random(std::uint32_t parts, std::uint64_t seed) const {
    sim::RandomStream chance(seed, "division", "parts");
    std::vector<std::uint32_t> part_of_block;
    for (std::uint32_t b = 0; b < blocks_.count; ++b)
      part_of_block.push_back(static_cast<std::uint32_t>(chance.below(parts)));
    return made_of(parts, part_of_block);
  }

 private:
  WeightedGraph whole_graph() const {
    WeightedGraph graph{std::vector<double>(blocks_.count, 0),
                        std::vector<std::vector<WeightedGraph::Edge>>(blocks_.count)};
    std::map<std::pair<std::uint32_t, std::uint32_t>, double> edges;
    // A link that carries nothing now may carry something when routes change.
    for (const models::LinkPlan& link : resolved_.plan.links)
      edges[std::minmax(blocks_.of_node[link.a.node.value], blocks_.of_node[link.b.node.value])] += 1e-3;
    for (const auto& [link, rate] : frames_) {
      const std::uint32_t from = blocks_.of_node[link.first], to = blocks_.of_node[link.second];
      graph.weights[to] += rate;
      edges[std::minmax(from, to)] += rate;
    }
    for (const auto& [ends, weight] : edges) {
      if (ends.first == ends.second) continue;
      graph.edges[ends.first].push_back({ends.second, weight});
      graph.edges[ends.second].push_back({ends.first, weight});
    }
    return graph;
  }

  /// The vertices of `graph`, which are the blocks `which`, into parts from `first` on.
  void split(const WeightedGraph& graph, const std::vector<std::uint32_t>& which, std::uint32_t parts,
             std::uint32_t first, std::vector<std::uint32_t>& part_of_block) const {
    if (parts == 1) {
      for (const std::uint32_t block : which) part_of_block[block] = first;
      return;
    }
    const std::uint32_t half = parts / 2;
    const auto home = std::find(which.begin(), which.end(), blocks_.home);
    const std::vector<bool> is_second =
        bisect(graph, static_cast<double>(half) / parts,
               home == which.end() ? 0xFFFF'FFFF : static_cast<std::uint32_t>(home - which.begin()));
    for (const bool second : {false, true}) {
      std::vector<std::uint32_t> place(which.size(), 0), blocks;
      WeightedGraph side;
      for (std::uint32_t v = 0; v < which.size(); ++v) {
        if (is_second[v] != second) continue;
        place[v] = static_cast<std::uint32_t>(blocks.size());
        blocks.push_back(which[v]);
        side.weights.push_back(graph.weights[v]);
      }
      for (std::uint32_t v = 0; v < which.size(); ++v) {
        if (is_second[v] != second) continue;
        std::vector<WeightedGraph::Edge>& edges = side.edges.emplace_back();
        for (const WeightedGraph::Edge& edge : graph.edges[v])
          if (is_second[edge.to] == second) edges.push_back({place[edge.to], edge.weight});
      }
      split(side, blocks, second ? parts - half : half, second ? first + half : first, part_of_block);
    }
  }

  /// Numbers the parts that have blocks, the one with Programs and applications first, and looks at what is between
  /// them.
  Division made_of(std::uint32_t parts, const std::vector<std::uint32_t>& part_of_block) const {
    std::vector<std::uint32_t> number(parts, 0xFFFF'FFFF);
    Division division;
    division.parts = 0;
    if (!part_of_block.empty()) number[part_of_block[blocks_.home]] = division.parts++;
    for (const std::uint32_t part : part_of_block)
      if (number[part] == 0xFFFF'FFFF) number[part] = division.parts++;
    for (const std::uint32_t block : blocks_.of_node) division.part_of_node.push_back(number[part_of_block[block]]);
    division.frame_hops_per_second.assign(division.parts, 0);
    for (const auto& [link, rate] : frames_) division.frame_hops_per_second[division.part_of_node[link.second]] += rate;
    add_boundaries(division);
    return division;
  }

  void add_boundaries(Division& division) const {
    const models::NetworkPlan& plan = resolved_.plan;
    std::map<std::pair<std::uint32_t, std::uint32_t>, Boundary> boundaries;
    for (const models::LinkPlan& link : plan.links) {
      for (const auto& [from, to] : {std::pair(link.a.node, link.b.node), std::pair(link.b.node, link.a.node)}) {
        const std::uint32_t here = division.part_of_node[from.value], there = division.part_of_node[to.value];
        if (here == there) continue;
        // Network::connect folds the same fixed delays into the arrival.
        const Duration receiver = plan.nodes[to.value].forwards() ? plan.nodes[to.value].forwarding_delay : Duration();
        const Duration promise =
            link.rate.octet_time() * (models::preamble_and_sfd + models::minimum_frame).count + link.delay + receiver;
        const auto [at, is_new] = boundaries.try_emplace({here, there}, Boundary{here, there, promise, 0, 0});
        at->second.promise = std::min(at->second.promise, promise);
        ++at->second.links;
        const auto rate = frames_.find({from.value, to.value});
        if (rate != frames_.end()) at->second.frames_per_second += rate->second;
      }
    }
    for (const auto& [parts, boundary] : boundaries) division.boundaries.push_back(boundary);
  }

  const Resolved& resolved_;
  Blocks blocks_;
  Crossing frames_;
};

double sum_of(const std::vector<double>& values) { return std::accumulate(values.begin(), values.end(), 0.0); }

/// Why so many parts would not be faster than fewer; empty: they would.
std::string why_not(const Division& division, std::uint32_t parts) {
  if (division.parts < parts) return "there is no more that can be simulated apart";
  const double all = sum_of(division.frame_hops_per_second);
  const double most = *std::max_element(division.frame_hops_per_second.begin(), division.frame_hops_per_second.end());
  if (most * parts > all * greatest_imbalance)
    return "one of " + std::to_string(parts) + " parts would have " + std::to_string(std::lround(100 * most / all)) +
           " % of all frames, since what it has must stay together";
  const double hops = all / parts * static_cast<double>(division.promise().ps()) / 1e12;
  if (hops < least_frame_hops_a_promise)
    return "parts that hear of each other after " + json::to_text(division.promise()) + " at the earliest would have " +
           std::to_string(std::lround(hops)) + " frames to move until then, at least " +
           std::to_string(static_cast<int>(least_frame_hops_a_promise)) + " are worth it";
  return {};
}

Division one_part(const Resolved& resolved, unsigned threads, std::string why) {
  Division division;
  division.asked = threads;
  division.part_of_node.assign(resolved.plan.nodes.size(), 0);
  division.why_fewer = std::move(why);
  return division;
}

}  // namespace

Duration Division::promise() const {
  return std::min_element(boundaries.begin(), boundaries.end(),
                          [](const Boundary& a, const Boundary& b) { return a.promise < b.promise; })
      ->promise;
}

double Division::crossing_share() const {
  double crossing = 0;
  for (const Boundary& boundary : boundaries) crossing += boundary.frames_per_second;
  const double all = sum_of(frame_hops_per_second);
  return all > 0 ? crossing / all : 0;
}

Division divide(const Resolved& resolved, unsigned threads) {
  if (threads <= 1) return one_part(resolved, threads, {});
  if (std::string why = why_whole(resolved); !why.empty()) return one_part(resolved, threads, std::move(why));
  const Divider divider(resolved);
  std::string why;
  for (std::uint32_t parts = std::min(threads, divider.blocks()); parts > 1; --parts) {
    Division division = divider.by_graph(parts);
    const std::string not_so_many = division.is_divided() && !division.boundaries.empty()
                                        ? why_not(division, parts)
                                        : "there is no more that can be simulated apart";
    if (not_so_many.empty()) {
      division.asked = threads;
      if (parts < threads) division.why_fewer = why.empty() ? "there is no more that can be simulated apart" : why;
      return division;
    }
    if (why.empty()) why = not_so_many;
  }
  return one_part(resolved, threads, why.empty() ? "all of it must be simulated by one thread" : why);
}

Division divide_at_random(const Resolved& resolved, unsigned parts, std::uint64_t seed) {
  if (std::string why = why_whole(resolved); !why.empty()) return one_part(resolved, parts, std::move(why));
  Division division = Divider(resolved).at_random(parts, seed);
  division.asked = parts;
  return division;
}

}  // namespace takt::scenario
