// SPDX-License-Identifier: Apache-2.0
#include "schedule/routes.hpp"

#include <limits>
#include <numeric>
#include <queue>
#include <utility>

namespace takt::schedule {
namespace {
constexpr std::uint16_t unreachable = std::numeric_limits<std::uint16_t>::max();
constexpr double infinite = std::numeric_limits<double>::infinity();
}  // namespace

Routes::Routes(const Timing& timing)
    : timing_(&timing),
      problem_(&timing.problem()),
      leaving_(problem_->nodes.size()),
      coming_(problem_->nodes.size()),
      is_closed_(problem_->links.size()),
      load_(problem_->links.size()),
      steps_to_(problem_->nodes.size()) {
  std::optional<Ps> forwarding;
  for (LinkIndex l = 0; l < problem_->links.size(); ++l) {
    const Link& link = problem_->links[l];
    leaving_[link.from].push_back(l);
    coming_[link.to].push_back(l);
    const Link& first = problem_->links.front();
    if (link.octet != first.octet || link.propagation != first.propagation) is_uniform_ = false;
    if (!problem_->nodes[link.to].is_bridge) continue;
    if (forwarding && *forwarding != link.forwarding) is_uniform_ = false;
    forwarding = link.forwarding;
  }
}

void Routes::close(LinkIndex link) {
  is_closed_[link] = 1;
  for (auto& steps : steps_to_) steps.clear();
}

/// How many links lie between each node and that one, not through end stations.
const std::vector<std::uint16_t>& Routes::steps_to(NodeIndex node) {
  auto& steps = steps_to_[node];
  if (!steps.empty()) return steps;
  steps.assign(problem_->nodes.size(), unreachable);
  std::vector<NodeIndex> queue{node};
  steps[node] = 0;
  for (std::size_t i = 0; i < queue.size(); ++i) {
    const NodeIndex here = queue[i];
    if (here != node && !problem_->nodes[here].is_bridge) continue;
    for (const LinkIndex l : coming_[here]) {
      const NodeIndex from = problem_->links[l].from;
      if (is_closed_[l] || steps[from] != unreachable) continue;
      steps[from] = static_cast<std::uint16_t>(steps[here] + 1);
      queue.push_back(from);
    }
  }
  return steps;
}

std::optional<std::vector<LinkIndex>> Routes::shortest_by_steps(const Stream& stream) {
  const auto& steps = steps_to(stream.listeners.front());
  if (steps[stream.talker] == unreachable) return std::nullopt;
  std::vector<LinkIndex> links;
  for (NodeIndex here = stream.talker; here != stream.listeners.front();) {
    std::optional<LinkIndex> best;
    for (const LinkIndex l : leaving_[here]) {
      if (is_closed_[l] || steps[problem_->links[l].to] + 1 != steps[here]) continue;
      if (!best || load_[l] < load_[*best]) best = l;
    }
    if (!best) return std::nullopt;
    links.push_back(*best);
    here = problem_->links[*best].to;
  }
  return links;
}

void Routes::note_load(const Stream& stream, const std::vector<LinkIndex>& links) {
  for (const LinkIndex l : links)
    load_[l] += static_cast<double>(timing_->work(stream, problem_->links[l])) / static_cast<double>(stream.period);
}

/// How long each link takes, with what is behind it.
std::vector<double> Routes::cost_of(const Stream& stream) const {
  std::vector<double> cost(problem_->links.size());
  for (LinkIndex l = 0; l < cost.size(); ++l) {
    const Link& link = problem_->links[l];
    const Ps head = link.cut_through ? *link.cut_through * link.octet : timing_->frame(stream, link);
    cost[l] = is_closed_[l] ? infinite : static_cast<double>(head + link.propagation + link.forwarding);
  }
  return cost;
}

/// Grows a tree from the talker, one listener after the other by the way of least cost from what there is.
/// `latency_share`: how much of what it takes to come to a node of the tree counts, 0 for few links, 1 for short ways.
std::optional<std::vector<LinkIndex>> Routes::tree(const Stream& stream, const std::vector<double>& cost,
                                                   double latency_share, const std::vector<NodeIndex>& order) const {
  const std::size_t nodes = problem_->nodes.size();
  std::vector<double> in_tree(nodes, -1.0);  // cost from the talker, of nodes of the tree
  in_tree[stream.talker] = 0;
  std::vector<LinkIndex> links;
  std::vector<double> distance(nodes);
  std::vector<LinkIndex> by(nodes);
  for (const NodeIndex listener : order) {
    if (in_tree[listener] >= 0) continue;
    std::fill(distance.begin(), distance.end(), infinite);
    std::priority_queue<std::pair<double, NodeIndex>, std::vector<std::pair<double, NodeIndex>>, std::greater<>> queue;
    for (NodeIndex n = 0; n < nodes; ++n)
      if (in_tree[n] >= 0 && (n == stream.talker || problem_->nodes[n].is_bridge)) {
        distance[n] = in_tree[n] * latency_share;
        queue.emplace(distance[n], n);
      }
    while (!queue.empty()) {
      const auto [at, here] = queue.top();
      queue.pop();
      if (at > distance[here]) continue;
      if (here == listener) break;
      if (here != stream.talker && !problem_->nodes[here].is_bridge) continue;
      for (const LinkIndex l : leaving_[here]) {
        const NodeIndex to = problem_->links[l].to;
        if (in_tree[to] >= 0 || distance[here] + cost[l] >= distance[to]) continue;
        distance[to] = distance[here] + cost[l];
        by[to] = l;
        queue.emplace(distance[to], to);
      }
    }
    if (distance[listener] == infinite) return std::nullopt;
    std::vector<LinkIndex> branch;
    for (NodeIndex n = listener; in_tree[n] < 0; n = problem_->links[by[n]].from) branch.push_back(by[n]);
    for (auto l = branch.rbegin(); l != branch.rend(); ++l) {
      const Link& link = problem_->links[*l];
      in_tree[link.to] = in_tree[link.from] + cost[*l];
      links.push_back(*l);
    }
  }
  return links;
}

std::optional<Way> Routes::first(StreamIndex index) {
  const Stream& stream = problem_->streams[index];
  std::optional<std::vector<LinkIndex>> links;
  if (stream.route) {
    links = stream.route;
    for (const LinkIndex l : *links)
      if (is_closed_[l]) return std::nullopt;
  } else if (is_uniform_ && stream.listeners.size() == 1) {
    links = shortest_by_steps(stream);
  } else {
    links = tree(stream, cost_of(stream), 1.0, stream.listeners);
  }
  if (!links) return std::nullopt;
  auto way = make_way(*timing_, stream, *links);
  if (way) note_load(stream, *links);
  return way;
}

std::vector<Way> Routes::several(StreamIndex index, const Way& first, std::size_t most,
                                 sim::RandomStream& random) const {
  const Stream& stream = problem_->streams[index];
  std::vector<Way> ways{first};
  if (stream.route) return ways;
  const std::vector<double> plain = cost_of(stream);
  std::vector<double> cost = plain;
  std::vector<NodeIndex> order = stream.listeners;
  std::size_t known = 0;
  for (const LinkIndex l : first.links) cost[l] *= 1.5;
  // Ways that were found before become dearer until others are found; what is found again and again is all there is.
  while (ways.size() < most && known < 2 * most + 8) {
    for (std::size_t i = order.size(); i > 1; --i) std::swap(order[i - 1], order[random.below(i)]);
    const double share = stream.listeners.size() == 1 ? 1.0 : static_cast<double>(random.below(3)) / 2;
    const auto links = tree(stream, cost, share, order);
    if (!links) break;
    for (const LinkIndex l : *links) cost[l] *= 1.15 + 0.5 * random.unit();
    const bool is_known = std::any_of(ways.begin(), ways.end(), [&](const Way& way) { return way.links == *links; });
    auto way = is_known ? std::nullopt : make_way(*timing_, stream, *links);
    if (way) {
      ways.push_back(std::move(*way));
    } else if (++known % 8 == 0) {
      cost = plain;
      for (double& each : cost) each *= 1 + random.unit();
    }
  }
  return ways;
}

}  // namespace takt::schedule
