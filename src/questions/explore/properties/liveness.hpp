// SPDX-License-Identifier: Apache-2.0
// L1 and F1 as convergence under fairness: no fair cycle of network steps outside the goal.
//
// Calls and faults come from budgets, so every cycle of the graph consists of network steps. An infinite run is fair if
// each network action is taken again and again, or would change nothing. As every action leads to one state, a strongly
// connected component can be stayed in fairly for ever if and only if each action leads from some state of it into it.
#pragma once

#include <algorithm>
#include <cstdint>
#include <deque>
#include <optional>
#include <span>
#include <vector>

#include "explore/model/hash_index.hpp"
#include "explore/model/model.hpp"
#include "explore/properties/components.hpp"
#include "explore/search/search.hpp"
#include "explore/search/state_store.hpp"
#include "sim/check.hpp"

namespace takt::explore {

struct FairCycle {
  StateStore::Position state = StateStore::nowhere;  ///< a state of the component outside the goal
  std::vector<StateStore::Position> component;       ///< sorted
};

struct Liveness {
  std::uint64_t cyclic_states = 0;
  std::optional<FairCycle> unsettled;  ///< L1
  std::optional<FairCycle> unhalted;   ///< F1: somebody is down
  bool interrupted = false;
};

/// Where the network actions lead from a state; itself where nothing changes.
template <Model M>
class Graph {
 public:
  using Position = StateStore::Position;

  Graph(M& model, const StateStore& store) : model_(&model), store_(&store) {}

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
  M* model_;
  const StateStore* store_;
  std::vector<Edge> edges_;
};

/// Which states may lie on a cycle of network steps.
template <Model M>
class Suspects {
 public:
  Suspects(M& model, const StateStore& store) : model_(&model), store_(&store), recurrence_(model.recurrence()) {}
  bool none() const { return recurrence_ == Recurrence::none; }
  bool contains(StateStore::Position position) const {
    return recurrence_ == Recurrence::all || model_->recurs((*store_)[position]);
  }

 private:
  const M* model_;
  const StateStore* store_;
  Recurrence recurrence_;
};

/// The suspects and the steps between them.
template <Model M>
class SuspectGraph {
 public:
  using Position = StateStore::Position;

  SuspectGraph(Graph<M>& graph, const Suspects<M>& suspects) : graph_(&graph), suspects_(&suspects) {}
  void successors(Position from, std::vector<Position>& to) {
    graph_->successors(from, to);
    to.erase(
        std::remove_if(to.begin(), to.end(), [&](Position each) { return each == from || !suspects_->contains(each); }),
        to.end());
  }

 private:
  Graph<M>* graph_;
  const Suspects<M>* suspects_;
};

inline bool contains(const std::vector<StateStore::Position>& component, StateStore::Position state) {
  return std::binary_search(component.begin(), component.end(), state);
}

/// Each action leads from some state of the component into it. With symmetry states stand for others with other names,
/// so the component is walked once more by names, from one of its states; whatever can be reached so is one component,
/// for the way from a state to itself under other names leads back in the end.
template <Model M>
bool is_fair(M& model, const StateStore& store, const std::vector<StateStore::Position>& component) {
  struct HashOfState {
    std::size_t operator()(const State& state) const { return state.hash(); }
  };
  const std::span<const Action> actions = model.network_actions();
  std::vector<bool> stays(actions.size(), false);
  std::size_t missing = actions.size();
  Interner<State, HashOfState> seen;
  seen.intern(store[component.front()]);
  Next next;
  for (std::size_t i = 0; i < seen.size() && missing != 0; ++i) {
    const State from = seen[i];
    for (std::size_t a = 0; a < actions.size(); ++a) {
      const bool moves = model.act(from, actions[a], next) && !(next.state == from);
      if (moves) {
        const State stored = model.canonical(next.state);
        if (!contains(component, store.find(stored, stored.hash()))) continue;
        seen.intern(next.state);
      }
      if (!stays[a]) --missing;
      stays[a] = true;
    }
  }
  return missing == 0;
}

/// Keeps the cycle that is found first in the search, which has the shortest way to it.
inline void keep(std::optional<FairCycle>& best, StateStore::Position outside,
                 const std::vector<StateStore::Position>& component) {
  if (best && best->state <= outside) return;
  best = FairCycle{outside, component};
}

/// All states of the space must be in the store.
template <Model M>
Liveness judge_cycles(M& model, const StateStore& store, const Watcher& watcher) {
  using Position = StateStore::Position;
  Liveness liveness;
  const Suspects<M> suspects(model, store);
  if (suspects.none()) return liveness;
  Graph<M> steps(model, store);
  SuspectGraph<M> graph(steps, suspects);
  Components<SuspectGraph<M>> components(graph, store.size());
  // From the end: most steps lead to later states, so the ways are short.
  for (auto root = static_cast<Position>(store.size()); root-- > 0;) {
    if ((root & 0xFFFFU) == 0 && !watcher({store.size(), store.size() - root, 0, store.memory(), true})) {
      liveness.interrupted = true;
      return liveness;
    }
    if (!suspects.contains(root)) continue;
    components.from(root, [&](const std::vector<Position>& component) {
      if (component.size() < 2) return;
      liveness.cyclic_states += component.size();
      const auto outside =
          std::find_if(component.begin(), component.end(), [&](Position each) { return !model.settled(store[each]); });
      if (outside == component.end() || !is_fair(model, store, component)) return;
      keep(model.anybody_down(store[*outside]) ? liveness.unhalted : liveness.unsettled, *outside, component);
    });
  }
  return liveness;
}

/// The network steps inside a component from one state back to itself; in the stored, canonical names.
template <Model M>
std::vector<StateStore::Position> once_around(M& model, const StateStore& store, const FairCycle& cycle) {
  using Position = StateStore::Position;
  Graph<M> graph(model, store);
  std::vector<Position> from(cycle.component.size(), StateStore::nowhere);
  const auto place = [&](Position state) {
    return static_cast<std::size_t>(std::lower_bound(cycle.component.begin(), cycle.component.end(), state) -
                                    cycle.component.begin());
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
