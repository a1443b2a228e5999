#include "explore/liveness.hpp"

#include <algorithm>
#include <deque>

#include "sim/check.hpp"

namespace takt::explore {
namespace {

using Position = StateStore::Position;

/// Where the network actions lead from a state; itself where nothing changes.
class Graph {
 public:
  Graph(Model& model, const StateStore& store) : model_(&model), store_(&store) {}

  /// By action. All are looked up together, so that memory can arrive.
  void successors(Position from, std::vector<Position>& to) {
    const State state = (*store_)[from];
    const std::span<const Action> actions = model_->network_actions();
    to.assign(actions.size(), from);
    edges_.clear();
    Next next;
    for (std::size_t a = 0; a < actions.size(); ++a) {
      if (!model_->act(state, actions[a], next)) continue;
      Edge& edge = edges_.emplace_back();
      edge.to = model_->canonical(next.state);
      edge.hash = edge.to.hash();
      edge.action = a;
      store_->prefetch_slot(edge.hash);
    }
    for (const Edge& each : edges_) store_->prefetch_state(each.hash);
    for (const Edge& each : edges_) {
      to[each.action] = store_->find(each.to, each.hash);
      TAKT_CHECK(to[each.action] != StateStore::nowhere, "every successor of a searched state is stored");
    }
  }

 private:
  struct Edge {
    State to;
    std::uint64_t hash = 0;
    std::size_t action = 0;
  };
  Model* model_;
  const StateStore* store_;
  std::vector<Edge> edges_;
};

/// Tarjan's strongly connected components, without recursion.
class Components {
 public:
  Components(Graph& graph, const StateStore& store)
      : graph_(&graph), index_(store.size(), 0), low_(store.size(), 0), on_stack_(store.size(), false) {}

  /// Calls found(component) for each component.
  template <class Found>
  void from(Position root, Found&& found) {
    if (index_[root] != 0) return;
    open(root);
    while (!frames_.empty()) {
      Frame& frame = frames_.back();
      if (frame.next < frame.to.size()) {
        const Position to = frame.to[frame.next++];
        if (to == frame.state) continue;
        if (index_[to] == 0) {
          open(to);
        } else if (on_stack_[to]) {
          low_[frame.state] = std::min(low_[frame.state], index_[to]);
        }
        continue;
      }
      const Position done = frame.state;
      frames_.pop_back();
      if (!frames_.empty()) low_[frames_.back().state] = std::min(low_[frames_.back().state], low_[done]);
      if (low_[done] == index_[done]) found(close(done));
    }
  }

 private:
  struct Frame {
    Position state;
    std::vector<Position> to;
    std::size_t next = 0;
  };
  void open(Position state) {
    index_[state] = low_[state] = ++count_;
    stack_.push_back(state);
    on_stack_[state] = true;
    frames_.push_back({state, {}, 0});
    graph_->successors(state, frames_.back().to);
  }
  std::vector<Position> close(Position root) {
    std::vector<Position> component;
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
  std::vector<Position> stack_;
  std::vector<Frame> frames_;
  std::uint32_t count_ = 0;
};

bool contains(const std::vector<Position>& component, Position state) { return std::binary_search(component.begin(), component.end(), state); }

/// Each action leads from some state of the component into it. With symmetry names do not count, so it is enough if one
/// action of each sort does: more components are called fair than are.
bool is_fair(Graph& graph, const std::vector<Position>& component, const Model& model) {
  const std::span<const Action> actions = model.network_actions();
  std::vector<bool> stays(actions.size(), false);
  std::vector<Position> to;
  for (const Position state : component) {
    graph.successors(state, to);
    for (std::size_t a = 0; a < actions.size(); ++a) stays[a] = stays[a] || contains(component, to[a]);
  }
  const auto sort_of = [&](const Action& action) {
    if (!model.question().symmetry) return action;
    const bool is_channel = action.kind == ActionKind::send || action.kind == ActionKind::receive;
    const bool of_slave = is_channel ? action.who < model.question().slaves : action.who != 0;
    return Action{action.kind, static_cast<std::uint8_t>(of_slave ? 1 : 0), 0};
  };
  for (const Action& wanted : actions) {
    bool found = false;
    for (std::size_t a = 0; a < actions.size(); ++a) found = found || (stays[a] && sort_of(actions[a]) == sort_of(wanted));
    if (!found) return false;
  }
  return true;
}

/// Keeps the cycle that is found first in the search, which has the shortest way to it.
void keep(std::optional<FairCycle>& best, Position outside, const std::vector<Position>& component) {
  if (best && best->state <= outside) return;
  best = FairCycle{outside, component};
}

}  // namespace

Liveness judge_cycles(Model& model, const StateStore& store, const Watcher& watcher) {
  Liveness liveness;
  Graph graph(model, store);
  Components components(graph, store);
  // From the end: most steps lead to later states, so the ways are short.
  for (auto root = static_cast<Position>(store.size()); root-- > 0;) {
    if ((root & 0xFFFFU) == 0 && !watcher(store.size(), store.size() - root, 0)) {
      liveness.interrupted = true;
      return liveness;
    }
    components.from(root, [&](const std::vector<Position>& component) {
      if (component.size() < 2) return;
      liveness.cyclic_states += component.size();
      const auto outside = std::find_if(component.begin(), component.end(), [&](Position each) { return !model.settled(store[each]); });
      if (outside == component.end() || !is_fair(graph, component, model)) return;
      keep(model.anybody_down(store[*outside]) ? liveness.unhalted : liveness.unsettled, *outside, component);
    });
  }
  return liveness;
}

std::vector<StateStore::Position> lap(Model& model, const StateStore& store, const FairCycle& cycle) {
  Graph graph(model, store);
  std::vector<Position> from(cycle.component.size(), StateStore::nowhere);
  const auto place = [&](Position state) {
    return static_cast<std::size_t>(std::lower_bound(cycle.component.begin(), cycle.component.end(), state) - cycle.component.begin());
  };
  std::deque<Position> open{cycle.state};
  std::vector<Position> to;
  while (!open.empty() && from[place(cycle.state)] == StateStore::nowhere) {
    const Position state = open.front();
    open.pop_front();
    graph.successors(state, to);
    for (const Position each : to) {
      if (each == state || !contains(cycle.component, each) || from[place(each)] != StateStore::nowhere) continue;
      from[place(each)] = state;
      open.push_back(each);
    }
  }
  std::vector<Position> way{cycle.state};
  while (from[place(way.back())] != cycle.state) way.push_back(from[place(way.back())]);
  way.push_back(cycle.state);
  std::reverse(way.begin(), way.end());
  return way;  // from the state back to itself
}

}  // namespace takt::explore
