// SPDX-License-Identifier: Apache-2.0
#include "small_problem.hpp"

#include <algorithm>

#include "sim/random.hpp"

namespace takt::schedule {

Problem line(std::size_t bridges, Ps propagation, Ps forwarding) {
  Problem problem;
  problem.name = "line";
  const auto join = [&](NodeIndex a, NodeIndex b) {
    for (const auto& [from, to] : {std::pair(a, b), std::pair(b, a)}) {
      Link link;
      link.name = problem.nodes[from].name + ">" + problem.nodes[to].name;
      link.from = from;
      link.to = to;
      link.propagation = propagation;
      link.forwarding = problem.nodes[to].is_bridge ? forwarding : 0;
      problem.links.push_back(link);
    }
  };
  for (std::size_t i = 0; i < bridges; ++i) {
    problem.nodes.push_back({"b" + std::to_string(i), true});
    problem.nodes.push_back({"h" + std::to_string(i), false});
  }
  for (std::size_t i = 0; i < bridges; ++i) join(static_cast<NodeIndex>(2 * i + 1), static_cast<NodeIndex>(2 * i));
  for (std::size_t i = 0; i + 1 < bridges; ++i) join(static_cast<NodeIndex>(2 * i), static_cast<NodeIndex>(2 * i + 2));
  return problem;
}

LinkIndex link_of(const Problem& problem, const std::string& name) {
  return static_cast<LinkIndex>(
      std::find_if(problem.links.begin(), problem.links.end(), [&](const Link& each) { return each.name == name; }) -
      problem.links.begin());
}

NodeIndex node_of(const Problem& problem, const std::string& name) {
  return static_cast<NodeIndex>(
      std::find_if(problem.nodes.begin(), problem.nodes.end(), [&](const Node& each) { return each.name == name; }) -
      problem.nodes.begin());
}

Stream& add_stream(Problem& problem, const std::string& from, const std::string& to, Ps length_us, Ps period) {
  Stream stream;
  stream.name = "s" + std::to_string(problem.streams.size());
  stream.talker = node_of(problem, from);
  stream.listeners = {node_of(problem, to)};
  stream.octets = static_cast<std::uint32_t>(length_us * 125 - 20);
  stream.period = period;
  problem.streams.push_back(stream);
  return problem.streams.back();
}

Problem random_problem(std::uint64_t seed) {
  sim::RandomStream random(seed, "problem", "test");
  const std::size_t bridges = 2 + random.below(4);
  Problem problem = line(bridges, static_cast<Ps>(random.below(3)) * 100'000, static_cast<Ps>(random.below(3)) * us);
  // A ring, sometimes; rates that differ, bridges that cut through.
  if (bridges > 2 && random.below(2) == 0)
    for (const auto& [a, b] :
         {std::pair<std::size_t, std::size_t>(0, bridges - 1), std::pair<std::size_t, std::size_t>(bridges - 1, 0)}) {
      Link link = problem.links.back();
      link.from = static_cast<NodeIndex>(2 * a);
      link.to = static_cast<NodeIndex>(2 * b);
      link.name = "ring" + std::to_string(a);
      problem.links.push_back(link);
    }
  for (Link& link : problem.links) {
    if (random.below(5) == 0) link.octet = 80'000;
    if (random.below(4) == 0 && problem.nodes[link.to].is_bridge) link.cut_through = 24;
  }
  problem.model.is_strict = random.below(2) == 0;
  problem.model.no_wait = random.below(4) == 0;
  problem.model.margin = random.below(3) == 0 ? 200'000 : 0;
  const Ps periods[] = {500 * us, 1000 * us, 2000 * us, 750 * us};
  const std::size_t count = 1 + random.below(12);
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t from = random.below(bridges);
    const std::size_t to = (from + 1 + random.below(bridges - 1)) % bridges;
    Stream& stream = add_stream(problem, "h" + std::to_string(from), "h" + std::to_string(to),
                                1 + static_cast<Ps>(random.below(8)), periods[random.below(4)]);
    if (random.below(4) == 0) stream.frames = 1 + static_cast<std::uint32_t>(random.below(3));
    if (random.below(4) == 0) stream.release = static_cast<Ps>(random.below(100)) * us;
    if (random.below(3) == 0) stream.deadline = stream.release + stream.period;
    if (random.below(3) == 0) stream.latency = static_cast<Ps>(300 + random.below(200)) * us;
    if (random.below(4) == 0) stream.jitter = 0;
    stream.traffic_class = static_cast<std::uint8_t>(6 + random.below(2));
    for (std::size_t other = 0; other < bridges; ++other)
      if (other != from && other != to && random.below(5) == 0)
        stream.listeners.push_back(node_of(problem, "h" + std::to_string(other)));
    std::sort(stream.listeners.begin(), stream.listeners.end());
  }
  return problem;
}

}  // namespace takt::schedule
