// SPDX-License-Identifier: Apache-2.0
#include "schedule/crossings.hpp"

#include <queue>
#include <utility>

namespace takt::schedule {

Crossings::Crossings(const Problem& problem)
    : problem_(&problem), timing_(problem, GateTiming::flowing), leaving_(problem.nodes.size()) {
  for (LinkIndex l = 0; l < problem.links.size(); ++l) leaving_[problem.links[l].from].push_back(l);
}

bool Crossings::may_use(const Stream& stream, LinkIndex link) const {
  if (stream.route && std::find(stream.route->begin(), stream.route->end(), link) == stream.route->end()) return false;
  const NodeIndex from = problem_->links[link].from;
  return from == stream.talker || problem_->nodes[from].is_bridge;
}

std::vector<Ps> Crossings::spread(const Stream& stream, const std::vector<std::pair<Ps, LinkIndex>>& from,
                                  std::optional<LinkIndex> without) const {
  std::vector<Ps> starts(problem_->links.size(), never);
  using Entry = std::pair<Ps, LinkIndex>;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue;
  for (const auto& [at, link] : from) {
    starts[link] = at;
    queue.emplace(at, link);
  }
  while (!queue.empty()) {
    const auto [at, here] = queue.top();
    queue.pop();
    if (at > starts[here]) continue;
    const NodeIndex node = problem_->links[here].to;
    if (!problem_->nodes[node].is_bridge) continue;
    for (const LinkIndex next : leaving_[node]) {
      if (next == without || !may_use(stream, next)) continue;
      const Ps there = at + timing_.onward(stream, problem_->links[here], problem_->links[next]);
      if (there >= starts[next]) continue;
      starts[next] = there;
      queue.emplace(there, next);
    }
  }
  return starts;
}

std::vector<Ps> Crossings::earliest_starts(const Stream& stream) const {
  std::vector<std::pair<Ps, LinkIndex>> from;
  for (const LinkIndex l : leaving_[stream.talker])
    if (may_use(stream, l)) from.emplace_back(0, l);
  return spread(stream, from);
}

std::vector<Ps> Crossings::earliest_starts_from(const Stream& stream, LinkIndex first) const {
  return spread(stream, {{0, first}});
}

Ps Crossings::arrival(const Stream& stream, NodeIndex listener, const std::vector<Ps>& starts) const {
  Ps soonest = never;
  for (LinkIndex l = 0; l < starts.size(); ++l)
    if (starts[l] != never && problem_->links[l].to == listener)
      soonest = std::min(soonest, starts[l] + timing_.to_listener(stream, problem_->links[l]));
  return soonest;
}

bool Crossings::reaches(const Stream& stream, NodeIndex listener, const std::vector<std::uint8_t>& without) const {
  std::vector<std::uint8_t> seen(problem_->nodes.size());
  std::vector<NodeIndex> stack{stream.talker};
  seen[stream.talker] = 1;
  while (!stack.empty()) {
    const NodeIndex here = stack.back();
    stack.pop_back();
    for (const LinkIndex l : leaving_[here]) {
      const NodeIndex to = problem_->links[l].to;
      if (without[l] || seen[to] || !may_use(stream, l)) continue;
      if (to == listener) return true;
      seen[to] = 1;
      stack.push_back(to);
    }
  }
  return false;
}

bool Crossings::reaches_in_time(const Stream& stream, NodeIndex listener, LinkIndex without) const {
  std::vector<std::pair<Ps, LinkIndex>> from;
  for (const LinkIndex l : leaving_[stream.talker])
    if (l != without && may_use(stream, l)) from.emplace_back(0, l);
  const Ps least = arrival(stream, listener, spread(stream, from, without));
  return least != never && !(stream.latency && least > *stream.latency) &&
         !(stream.deadline && least > *stream.deadline - stream.release);
}

std::vector<LinkIndex> Crossings::needed(const Stream& stream, bool in_time) const {
  if (stream.route) return *stream.route;
  // Only links of some way to a listener can be needed; one way is enough to name them.
  std::vector<LinkIndex> all;
  std::vector<std::uint8_t> without(problem_->links.size());
  for (const NodeIndex listener : stream.listeners) {
    std::vector<std::int64_t> by(problem_->nodes.size(), -1);
    std::vector<NodeIndex> queue{stream.talker};
    std::vector<std::uint8_t> seen(problem_->nodes.size());
    seen[stream.talker] = 1;
    for (std::size_t i = 0; i < queue.size() && !seen[listener]; ++i)
      for (const LinkIndex l : leaving_[queue[i]]) {
        const NodeIndex to = problem_->links[l].to;
        if (seen[to] || !may_use(stream, l)) continue;
        seen[to] = 1;
        by[to] = l;
        queue.push_back(to);
      }
    if (!seen[listener]) continue;
    for (NodeIndex n = listener; n != stream.talker;) {
      const auto l = static_cast<LinkIndex>(by[n]);
      n = problem_->links[l].from;
      if (std::find(all.begin(), all.end(), l) != all.end()) continue;
      without[l] = 1;
      if (in_time ? !reaches_in_time(stream, listener, l) : !reaches(stream, listener, without)) all.push_back(l);
      without[l] = 0;
    }
  }
  std::sort(all.begin(), all.end());
  return all;
}

}  // namespace takt::schedule
