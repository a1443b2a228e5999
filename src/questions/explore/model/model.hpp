// SPDX-License-Identifier: Apache-2.0
// What a search needs of whatever it searches: how runs begin, which actions there are, and what each makes of a state.
#pragma once

#include <concepts>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "explore/model/action.hpp"
#include "explore/model/query.hpp"
#include "explore/model/state.hpp"
#include "explore/properties/property.hpp"

namespace takt::explore {

/// One way in which a run begins: switched on, or at rest after some calls at the master.
struct Beginning {
  std::string name;
  std::vector<Action> actions;  ///< from switched on
  State state;
};

/// What an action leads to.
struct Next {
  State state;
  PropertySet properties;  ///< violated or reached by it
};

/// Which states may lie on cycles of network steps.
enum class Recurrence : std::uint8_t { none, some, all };

/// The part of a Model whose participants are told apart, and of which nothing is known of who can go round.
class ToldApart {
 public:
  bool with_symmetry() const { return false; }
  bool symmetric() const { return true; }
  const State& canonical(const State& state) const { return state; }
  Recurrence recurrence() const { return Recurrence::all; }
  bool recurs(const State&) const { return true; }
};

template <class M>
concept Model = std::constructible_from<M, const Query&> &&
    requires(M& model, const M& known, const State& state, Action action, Next& next) {
  { known.query() } -> std::same_as<const Query&>;
  { known.shape() } -> std::same_as<const Shape&>;
  { known.beginnings() } -> std::same_as<const std::vector<Beginning>&>;
  /// Network actions first, calls then, faults last.
  { known.actions() } -> std::same_as<std::span<const Action>>;
  { known.network_actions() } -> std::same_as<std::span<const Action>>;
  /// Of the adversary, those that a state may allow: nothing that was left out is possible in it.
  { known.calls(state) } -> std::same_as<std::span<const Action>>;
  { known.faults(state) } -> std::same_as<std::span<const Action>>;
  /// False if the action is not possible, or changes nothing.
  { model.act(state, action, next) } -> std::same_as<bool>;

  /// Whether states may stand for others with other names; canonical(state) is the one that stands for all of them.
  { known.with_symmetry() } -> std::same_as<bool>;
  { model.canonical(state) } -> std::convertible_to<State>;
  /// False: names have turned out to matter; only without symmetry are the results right.
  { known.symmetric() } -> std::same_as<bool>;

  /// The goal of L1 (somebody down: of F1) holds.
  { known.settled(state) } -> std::same_as<bool>;
  { known.anybody_down(state) } -> std::same_as<bool>;
  { known.all_running(state) } -> std::same_as<bool>;
  /// To be asked when all states are known; then, where some recur, of each of them.
  { model.recurrence() } -> std::same_as<Recurrence>;
  { known.recurs(state) } -> std::same_as<bool>;

  /// Different values of participants, different words.
  { known.value_count() } -> std::convertible_to<std::uint64_t>;
  { known.word_count() } -> std::convertible_to<std::uint64_t>;
};

}  // namespace takt::explore
