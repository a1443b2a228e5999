// SPDX-License-Identifier: Apache-2.0
// Breadth-first search over all states of a model, and what it decides. The first run that violates or reaches
// something is a shortest one.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "explore/model/model.hpp"
#include "explore/properties/property.hpp"
#include "explore/search/state_store.hpp"

namespace takt::explore {

struct Progress {
  std::uint64_t states = 0;  ///< found so far
  std::uint64_t done = 0;    ///< of them: expanded, or (in_cycles) judged
  std::uint32_t depth = 0;
  std::uint64_t octets = 0;  ///< of states and their table
  bool in_cycles = false;    ///< all were found; cycles are judged
};
/// Asked now and then; false ends the search, and the result is partial.
using Watcher = std::function<bool(const Progress&)>;

/// A run, concrete: slaves keep their names.
struct Trace {
  std::size_t beginning = 0;    ///< of the model's beginnings
  std::vector<Action> actions;  ///< after it
  std::size_t cycle = 0;        ///< the last so many of them repeat for ever; 0: nothing more can happen (L1, F1)
};

struct SearchResult {
  std::uint64_t states = 0;
  std::uint64_t transitions = 0;  ///< that change something
  std::uint32_t depth = 0;        ///< of the deepest state
  bool exhausted = false;         ///< every state within the budgets of calls and faults was seen
  bool interrupted = false;
  bool symmetry = false;            ///< was used in the end
  std::uint64_t cyclic_states = 0;  ///< on cycles of network steps
  std::uint64_t octets = 0;         ///< of stored states and their table
  std::uint64_t participants = 0;   ///< different values of participants
  std::uint64_t words = 0;          ///< different words
  std::uint64_t quiescent = 0;      ///< states in which nothing changes any more without the adversary
  std::vector<Beginning> beginnings;
  std::array<PropertyVerdict, property_count> verdicts{};
  std::array<std::optional<Trace>, property_count> traces;  ///< of what is violated or reached
  std::optional<Trace> livelock;  ///< L1: a cycle that never ends, even if L1 is violated in a shorter way, too

  PropertyVerdict operator[](Property property) const { return verdicts[index_of(property)]; }
  /// Whatever must hold holds and whatever must be reached is reached.
  bool all_hold() const;
  bool any_violated() const;
};

/// Searches all states of one Model (engine.hpp). Symmetry is given up by itself where slaves turn out not to be equal,
/// or where cycles of network steps have to be judged by names.
template <class M>
SearchResult search(const Query& query, const Watcher& watcher);

/// The search of the model that the query is of.
SearchResult explore(const Query& query, const Watcher& watcher);

}  // namespace takt::explore
