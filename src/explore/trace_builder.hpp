// From positions in the store back to a run that can be told: concrete actions from a beginning.
#pragma once

#include <optional>
#include <vector>

#include "explore/model.hpp"
#include "explore/search.hpp"
#include "explore/state_store.hpp"

namespace takt::explore {

class TraceBuilder {
 public:
  TraceBuilder(Model& model, const StateStore& store) : model_(&model), store_(&store) {}

  /// A shortest run to a state. Nothing if the names of slaves got lost on the way (then symmetry must be given up).
  std::optional<Trace> to(StateStore::Position target);
  /// The same, and then an action that violates or reaches the property.
  std::optional<Trace> to(StateStore::Position target, Property property);
  /// The same, and then once around the cycle `lap` of states, which begins and ends with the target.
  std::optional<Trace> around(const std::vector<StateStore::Position>& lap);

 private:
  bool walk_to(StateStore::Position target);
  bool follow(StateStore::Position next);

  Model* model_;
  const StateStore* store_;
  Trace trace_;
  State now_;
};

}  // namespace takt::explore
