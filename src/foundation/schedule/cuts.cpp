// SPDX-License-Identifier: Apache-2.0
#include "schedule/cuts.hpp"

#include <algorithm>
#include <utility>

namespace takt::schedule {
namespace {

/// The network without directions: nodes and cables.
class Cables {
 public:
  explicit Cables(const Problem& problem) : at_(problem.nodes.size()) {
    std::vector<std::pair<NodeIndex, NodeIndex>> ends;
    for (const Link& link : problem.links)
      ends.emplace_back(std::min(link.from, link.to), std::max(link.from, link.to));
    std::sort(ends.begin(), ends.end());
    ends.erase(std::unique(ends.begin(), ends.end()), ends.end());
    for (std::size_t c = 0; c < ends.size(); ++c) {
      at_[ends[c].first].emplace_back(c, ends[c].second);
      at_[ends[c].second].emplace_back(c, ends[c].first);
    }
    count_ = ends.size();
  }

  std::size_t count() const { return count_; }

  /// Walks in depth first and notes for each node when it was entered, how many lie in its branch, and for each cable
  /// that is the only one into its branch that node.
  struct Walk {
    std::vector<std::size_t> entered, size, lowest;
    std::vector<std::pair<std::size_t, NodeIndex>> single;  ///< cable, node behind it
    std::size_t seen = 0;
  };
  Walk walk(std::size_t without) const {
    Walk walk;
    walk.entered.assign(at_.size(), 0);
    walk.size.assign(at_.size(), 1);
    walk.lowest.assign(at_.size(), 0);
    struct Step {
      NodeIndex node;
      std::size_t by, next;
    };
    std::vector<Step> path{{0, count_, 0}};
    walk.entered[0] = walk.lowest[0] = ++walk.seen;
    while (!path.empty()) {
      Step& step = path.back();
      if (step.next < at_[step.node].size()) {
        const auto [cable, to] = at_[step.node][step.next++];
        if (cable == without || cable == step.by) continue;
        if (walk.entered[to] != 0) {
          walk.lowest[step.node] = std::min(walk.lowest[step.node], walk.entered[to]);
          continue;
        }
        walk.entered[to] = walk.lowest[to] = ++walk.seen;
        path.push_back({to, cable, 0});
        continue;
      }
      const Step done = step;
      path.pop_back();
      if (path.empty()) break;
      const NodeIndex parent = path.back().node;
      walk.size[parent] += walk.size[done.node];
      walk.lowest[parent] = std::min(walk.lowest[parent], walk.lowest[done.node]);
      if (walk.lowest[done.node] > walk.entered[parent]) walk.single.emplace_back(done.by, done.node);
    }
    return walk;
  }

 private:
  std::vector<std::vector<std::pair<std::size_t, NodeIndex>>> at_;  ///< by node: cable, other end
  std::size_t count_ = 0;
};

}  // namespace

void for_each_double_cut(const Problem& problem, const std::function<bool(const Cut&)>& see) {
  if (problem.nodes.empty()) return;
  const Cables cables(problem);
  std::vector<std::uint8_t> splits(cables.count() + 1);
  for (const auto& [cable, node] : cables.walk(cables.count()).single) splits[cable] = 1;
  Cut cut;
  for (std::size_t first = 0; first < cables.count(); ++first) {
    if (splits[first]) continue;
    const auto walk = cables.walk(first);
    for (const auto& [second, node] : walk.single) {
      if (second < first || splits[second]) continue;
      for (const bool inside : {true, false}) {
        cut.is_behind.assign(problem.nodes.size(), 0);
        for (NodeIndex n = 0; n < problem.nodes.size(); ++n) {
          const bool is_in_branch =
              walk.entered[n] >= walk.entered[node] && walk.entered[n] < walk.entered[node] + walk.size[node];
          cut.is_behind[n] = is_in_branch == inside ? 1 : 0;
        }
        cut.links.clear();
        for (LinkIndex l = 0; l < problem.links.size(); ++l)
          if (!cut.is_behind[problem.links[l].from] && cut.is_behind[problem.links[l].to]) cut.links.push_back(l);
        if (!see(cut)) return;
      }
    }
  }
}

}  // namespace takt::schedule
