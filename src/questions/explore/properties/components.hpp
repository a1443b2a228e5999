// SPDX-License-Identifier: Apache-2.0
// Tarjan's strongly connected components, without recursion, of any graph whose nodes are numbers.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace takt::explore {

/// `Graph` has `void successors(std::uint32_t from, std::vector<std::uint32_t>& to)`; a node among its own successors
/// is passed over.
template <class Graph>
class Components {
 public:
  using Node = std::uint32_t;

  Components(Graph& graph, std::size_t nodes)
      : graph_(&graph), index_(nodes, 0), low_(nodes, 0), on_stack_(nodes, false) {}

  /// Calls found(component) for each component that can be reached from here and was not found yet; its nodes rise.
  template <class Found>
  void from(Node root, Found&& found) {
    if (index_[root] != 0) return;
    open(root);
    while (!frames_.empty()) {
      Frame& frame = frames_.back();
      if (frame.next < frame.to.size()) {
        const Node to = frame.to[frame.next++];
        if (to == frame.node) continue;
        if (index_[to] == 0) {
          open(to);
        } else if (on_stack_[to]) {
          low_[frame.node] = std::min(low_[frame.node], index_[to]);
        }
        continue;
      }
      const Node done = frame.node;
      frames_.pop_back();
      if (!frames_.empty()) low_[frames_.back().node] = std::min(low_[frames_.back().node], low_[done]);
      if (low_[done] == index_[done]) found(close(done));
    }
  }

 private:
  struct Frame {
    Node node;
    std::vector<Node> to;
    std::size_t next = 0;
  };
  void open(Node node) {
    index_[node] = low_[node] = ++count_;
    stack_.push_back(node);
    on_stack_[node] = true;
    frames_.push_back({node, {}, 0});
    graph_->successors(node, frames_.back().to);
  }
  std::vector<Node> close(Node root) {
    std::vector<Node> component;
    do {
      component.push_back(stack_.back());
      on_stack_[stack_.back()] = false;
      stack_.pop_back();
    } while (component.back() != root);
    std::sort(component.begin(), component.end());
    return component;
  }

  Graph* graph_;
  std::vector<std::uint32_t> index_;
  std::vector<std::uint32_t> low_;
  std::vector<bool> on_stack_;
  std::vector<Node> stack_;
  std::vector<Frame> frames_;
  std::uint32_t count_ = 0;
};

}  // namespace takt::explore
