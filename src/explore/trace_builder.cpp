#include "explore/trace_builder.hpp"

#include <algorithm>

namespace takt::explore {

std::optional<Trace> TraceBuilder::to(StateStore::Position target) {
  if (!walk_to(target)) return std::nullopt;
  return trace_;
}

std::optional<Trace> TraceBuilder::to(StateStore::Position target, Property property) {
  if (!walk_to(target)) return std::nullopt;
  Next next;
  for (const Action action : model_->actions()) {
    if (!model_->act(now_, action, next) || !next.properties.contains(property)) continue;
    trace_.actions.push_back(action);
    return trace_;
  }
  return std::nullopt;
}

std::optional<Trace> TraceBuilder::around(const std::vector<StateStore::Position>& lap) {
  if (!walk_to(lap.front())) return std::nullopt;
  for (std::size_t i = 1; i < lap.size(); ++i)
    if (!follow(lap[i])) return std::nullopt;
  trace_.cycle = lap.size() - 1;
  return trace_;
}

bool TraceBuilder::walk_to(StateStore::Position target) {
  std::vector<StateStore::Position> way{target};
  while (store_->parent(way.back()) != StateStore::nowhere) way.push_back(store_->parent(way.back()));
  std::reverse(way.begin(), way.end());
  const std::vector<Beginning>& beginnings = model_->beginnings();
  const State first = (*store_)[way.front()];
  const auto beginning = std::find_if(beginnings.begin(), beginnings.end(), [&](const Beginning& each) { return model_->canonical(each.state) == first; });
  if (beginning == beginnings.end()) return false;
  trace_ = Trace{static_cast<std::size_t>(beginning - beginnings.begin()), {}, 0};
  now_ = beginning->state;
  for (std::size_t i = 1; i < way.size(); ++i)
    if (!follow(way[i])) return false;
  return true;
}

/// Takes the first action from here that leads to a state which is that one up to names.
bool TraceBuilder::follow(StateStore::Position next_position) {
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
