// SPDX-License-Identifier: Apache-2.0
// From positions in the store back to a run that can be told: concrete actions from a beginning.
#pragma once

#include <algorithm>
#include <optional>
#include <vector>

#include "explore/model/model.hpp"
#include "explore/search/search.hpp"
#include "explore/search/state_store.hpp"

namespace takt::explore {

template <Model M>
class TraceBuilder {
 public:
  TraceBuilder(M& model, const StateStore& store) : model_(&model), store_(&store) {}

  /// A shortest run to a state. Nothing if the names of slaves got lost on the way (then symmetry must be given up).
  std::optional<Trace> to(StateStore::Position target);
  /// The same, and then an action that violates or reaches the property.
  std::optional<Trace> to(StateStore::Position target, Property property);
  /// The same, and then once around this cycle of states, which begins and ends with the target.
  std::optional<Trace> around(const std::vector<StateStore::Position>& cycle);

 private:
  bool walk_to(StateStore::Position target);
  /// Takes the first action from here that leads to a state which is that one up to names.
  bool follow(StateStore::Position next);

  M* model_;
  const StateStore* store_;
  Trace trace_;
  State now_;
};

template <Model M>
std::optional<Trace> TraceBuilder<M>::to(StateStore::Position target) {
  if (!walk_to(target)) return std::nullopt;
  return trace_;
}

template <Model M>
std::optional<Trace> TraceBuilder<M>::to(StateStore::Position target, Property property) {
  if (!walk_to(target)) return std::nullopt;
  Next next;
  for (const Action action : model_->actions()) {
    if (!model_->act(now_, action, next) || !next.properties.contains(property)) continue;
    trace_.actions.push_back(action);
    return trace_;
  }
  return std::nullopt;
}

template <Model M>
std::optional<Trace> TraceBuilder<M>::around(const std::vector<StateStore::Position>& cycle) {
  if (!walk_to(cycle.front())) return std::nullopt;
  for (std::size_t i = 1; i < cycle.size(); ++i)
    if (!follow(cycle[i])) return std::nullopt;
  trace_.cycle = cycle.size() - 1;
  return trace_;
}

template <Model M>
bool TraceBuilder<M>::walk_to(StateStore::Position target) {
  std::vector<StateStore::Position> way{target};
  while (store_->parent(way.back()) != StateStore::nowhere) way.push_back(store_->parent(way.back()));
  std::reverse(way.begin(), way.end());
  const std::vector<Beginning>& beginnings = model_->beginnings();
  const State first = (*store_)[way.front()];
  const auto beginning = std::find_if(beginnings.begin(), beginnings.end(),
                                      [&](const Beginning& each) { return model_->canonical(each.state) == first; });
  if (beginning == beginnings.end()) return false;
  trace_ = Trace{static_cast<std::size_t>(beginning - beginnings.begin()), {}, 0};
  now_ = beginning->state;
  for (std::size_t i = 1; i < way.size(); ++i)
    if (!follow(way[i])) return false;
  return true;
}

template <Model M>
bool TraceBuilder<M>::follow(StateStore::Position next_position) {
  const State wanted = (*store_)[next_position];
  Next next;
  for (const Action action : model_->actions()) {
    if (!model_->act(now_, action, next) || !(model_->canonical(next.state) == wanted)) continue;
    now_ = next.state;
    trace_.actions.push_back(action);
    return true;
  }
  return false;
}

}  // namespace takt::explore
