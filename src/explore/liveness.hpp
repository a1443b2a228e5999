// L1 and F1 as convergence under fairness: no fair cycle of network steps outside the goal.
//
// Calls and faults come from budgets, so every cycle of the graph consists of network steps. An infinite run is fair if
// each network action is taken again and again, or would change nothing. As every action leads to one state, a strongly
// connected component can be stayed in fairly for ever if and only if each action leads from some state of it into it.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "explore/model.hpp"
#include "explore/search.hpp"
#include "explore/state_store.hpp"

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

/// All states of the space must be in the store.
Liveness judge_cycles(Model& model, const StateStore& store, const Watcher& watcher);

/// The network steps inside a component from one state back to itself; in the stored, canonical names.
std::vector<StateStore::Position> lap(Model& model, const StateStore& store, const FairCycle& cycle);

}  // namespace takt::explore
