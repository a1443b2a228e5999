// SPDX-License-Identifier: Apache-2.0
#include "scenario/division/bisection.hpp"

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

namespace takt::scenario {
namespace {

constexpr std::uint32_t nobody = 0xFFFF'FFFF;
constexpr double tolerance = 0.03;  // of all weight, by which a part may be off its share
constexpr int most_passes = 8;
constexpr int starts = 4;

class Bisection {
 public:
  Bisection(const WeightedGraph& graph, double share, std::uint32_t fixed)
      : graph_(graph), fixed_(fixed), is_second_(graph.weights.size(), true) {
    for (const double weight : graph.weights) total_ += weight;
    wanted_ = share * total_;
  }

  void grow_from(std::uint32_t start) {
    std::fill(is_second_.begin(), is_second_.end(), true);
    first_ = 0;
    // The vertex goes next whose edges lead most to what is in already, and least elsewhere.
    std::set<std::pair<double, std::uint32_t>> border;
    std::vector<double> gain(is_second_.size());
    for (std::uint32_t v = 0; v < gain.size(); ++v) gain[v] = -degree(v);
    const auto add = [&](std::uint32_t v) {
      border.erase({-gain[v], v});
      is_second_[v] = false;
      first_ += graph_.weights[v];
      for (const WeightedGraph::Edge& edge : graph_.edges[v]) {
        if (!is_second_[edge.to]) continue;
        border.erase({-gain[edge.to], edge.to});
        gain[edge.to] += 2 * edge.weight;
        border.insert({-gain[edge.to], edge.to});
      }
    };
    if (fixed_ != nobody) add(fixed_);
    if (is_second_[start]) add(start);
    for (std::uint32_t next = 0; first_ < wanted_;) {
      if (!border.empty()) {
        const std::uint32_t v = border.begin()->second;
        if (first_ + graph_.weights[v] / 2 > wanted_) break;
        add(v);
        continue;
      }
      while (next < is_second_.size() && !is_second_[next]) ++next;  // another component
      if (next == is_second_.size() || first_ + graph_.weights[next] / 2 > wanted_) break;
      add(next);
    }
  }

  /// Moves single vertices as long as that makes the cut less.
  void refine() {
    for (int pass = 0; pass < most_passes && refine_once(); ++pass) {
    }
  }

  double cut() const {
    double sum = 0;
    for (std::uint32_t v = 0; v < is_second_.size(); ++v)
      for (const WeightedGraph::Edge& edge : graph_.edges[v])
        if (v < edge.to && is_second_[v] != is_second_[edge.to]) sum += edge.weight;
    return sum;
  }
  double imbalance() const { return std::abs(first_ - wanted_); }
  const std::vector<bool>& is_second() const { return is_second_; }

 private:
  double degree(std::uint32_t v) const {
    double sum = 0;
    for (const WeightedGraph::Edge& edge : graph_.edges[v]) sum += edge.weight;
    return sum;
  }
  double gain_of(std::uint32_t v) const {
    double gain = 0;
    for (const WeightedGraph::Edge& edge : graph_.edges[v])
      gain += is_second_[v] != is_second_[edge.to] ? edge.weight : -edge.weight;
    return gain;
  }
  bool may_move(std::uint32_t v) const {
    const double first = first_ + (is_second_[v] ? graph_.weights[v] : -graph_.weights[v]);
    return std::abs(first - wanted_) <= std::max(tolerance * total_, imbalance());
  }
  void move(std::uint32_t v) {
    first_ += is_second_[v] ? graph_.weights[v] : -graph_.weights[v];
    is_second_[v] = !is_second_[v];
  }

  /// Each vertex moves at most once, the one with the greatest gain first, also if that is a loss; then all moves
  /// behind the best moment are taken back.
  bool refine_once() {
    std::vector<double> gain(is_second_.size());
    std::set<std::pair<double, std::uint32_t>> movable;
    for (std::uint32_t v = 0; v < gain.size(); ++v) {
      gain[v] = gain_of(v);
      if (v != fixed_) movable.insert({-gain[v], v});
    }
    std::vector<std::uint32_t> moved;
    double sum = 0, best = 0;
    std::size_t best_moves = 0;
    const std::size_t most_idle = 50 + gain.size() / 20;
    while (!movable.empty() && moved.size() < best_moves + most_idle) {
      const auto at =
          std::find_if(movable.begin(), movable.end(), [&](const auto& each) { return may_move(each.second); });
      if (at == movable.end()) break;
      const std::uint32_t v = at->second;
      movable.erase(at);
      sum += gain[v];
      move(v);
      moved.push_back(v);
      for (const WeightedGraph::Edge& edge : graph_.edges[v]) {
        const bool was_in = movable.erase({-gain[edge.to], edge.to}) > 0;
        gain[edge.to] = gain_of(edge.to);
        if (was_in) movable.insert({-gain[edge.to], edge.to});
      }
      if (sum > best * (1 + 1e-9)) {
        best = sum;
        best_moves = moved.size();
      }
    }
    while (moved.size() > best_moves) {
      move(moved.back());
      moved.pop_back();
    }
    return best > 0;
  }

  const WeightedGraph& graph_;
  std::uint32_t fixed_;
  std::vector<bool> is_second_;
  double total_ = 0, wanted_ = 0, first_ = 0;
};

/// The vertex that is farthest from `start`, by edges.
std::uint32_t farthest_from(const WeightedGraph& graph, std::uint32_t start) {
  std::vector<bool> is_seen(graph.weights.size(), false);
  std::vector<std::uint32_t> order = {start};
  is_seen[start] = true;
  for (std::size_t i = 0; i < order.size(); ++i)
    for (const WeightedGraph::Edge& edge : graph.edges[order[i]])
      if (!is_seen[edge.to]) {
        is_seen[edge.to] = true;
        order.push_back(edge.to);
      }
  return order.back();
}

}  // namespace

std::vector<bool> bisect(const WeightedGraph& graph, double share, std::uint32_t fixed) {
  if (graph.weights.empty()) return {};
  std::vector<bool> best;
  double least_cut = 0, least_imbalance = 0;
  std::uint32_t start = fixed != nobody ? fixed : farthest_from(graph, 0);
  for (int i = 0; i < starts; ++i) {
    Bisection bisection(graph, share, fixed);
    bisection.grow_from(start);
    bisection.refine();
    const double cut = bisection.cut();
    if (best.empty() || cut < least_cut || (cut == least_cut && bisection.imbalance() < least_imbalance)) {
      best = bisection.is_second();
      least_cut = cut;
      least_imbalance = bisection.imbalance();
    }
    start = i % 2 == 0 ? farthest_from(graph, start)
                       : static_cast<std::uint32_t>(graph.weights.size()) * static_cast<std::uint32_t>(i) / starts;
  }
  return best;
}

}  // namespace takt::scenario
