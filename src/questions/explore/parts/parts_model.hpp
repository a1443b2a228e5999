// SPDX-License-Identifier: Apache-2.0
// One star of equal slaves on sampled registers, in parts: a state is the master and its slaves' parts in rising order,
// with budgets. The counterpart of group_model.hpp for more slaves than that can tell apart; README.md says why both
// have the same runs.
//
// There is no action `send` here: what may stand in a register is part of the state (said.hpp). `receive` says how many
// newer words its sender has had than the one that is heard. told() turns a run into one with `send`, for people and
// for replay.hpp.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "explore/model/action_list.hpp"
#include "explore/model/model.hpp"
#include "explore/parts/parts.hpp"
#include "explore/search/search.hpp"

namespace takt::explore {

class PartsModel : public ActionList {
 public:
  explicit PartsModel(const Query& query);
  PartsModel(const PartsModel&) = delete;
  PartsModel& operator=(const PartsModel&) = delete;

  const Query& query() const { return query_; }
  const Shape& shape() const { return shape_; }
  const std::vector<Beginning>& beginnings() const { return beginnings_; }

  bool act(const State& state, Action action, Next& next);
  State canonical(const State& state) const;

  bool settled(const State& state) const;
  bool anybody_down(const State& state) const;
  bool all_running(const State& state) const;
  bool with_symmetry() const { return query_.slaves > 1; }
  bool symmetric() const { return parts_.are_sound() && parts_.longest_said() <= most_words; }
  /// Of those that may stand in a register: more are not looked at.
  static constexpr std::size_t most_words = 24;
  Recurrence recurrence() const { return parts_.go_forward() ? Recurrence::none : Recurrence::all; }
  bool recurs(const State&) const { return true; }
  std::size_t value_count() const { return parts_.values(); }
  std::size_t word_count() const { return parts_.words(); }

  handshake::PublishedState state_of(const State& state, std::size_t participant) const;
  MasterId master(const State& state) const { return state.member(0); }
  /// `slave`: 1 and on.
  SlaveId slave(const State& state, std::size_t slave) const { return state.member(slave); }
  Parts& parts() { return parts_; }
  const Parts& parts() const { return parts_; }

  State switched_on();
  /// The same run with `send`.
  Beginning told(const Beginning& beginning);
  Trace told(const Trace& trace);

 private:
  void list_actions();
  void make_beginnings();
  bool change(const State& state, Action action, Next& next);
  bool take(const State& state, std::size_t slave, Action action, Next& next);
  Others others(const State& state, std::size_t but) const;
  /// S1 and S2 of who has become Running.
  void judge(const Outcome& outcome, Next& next) const;
  bool is_free(const State& state, Action action) const;

  Query query_;
  Shape shape_;
  Parts parts_;
  std::vector<Beginning> beginnings_;
};

}  // namespace takt::explore
