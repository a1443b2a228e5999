// SPDX-License-Identifier: Apache-2.0
// A group nested in another one, or a group with a slave that joins, on sampled registers: which actions there are, and
// what each makes of a state. The counterpart of group_model.hpp, whose State it fills: nodes instead of participants,
// a word in each channel, a SmallObserver of the tree.
//
// Actions name participants as TreeShape numbers them; crash and restart take the whole node, which `who` then numbers.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "explore/model/action_list.hpp"
#include "explore/model/model.hpp"
#include "explore/model/tree_nodes.hpp"

namespace takt::explore {

class TreeModel : public ActionList, public ToldApart {
 public:
  explicit TreeModel(const Query& query);

  const Query& query() const { return query_; }
  const TreeShape& tree() const { return tree_; }
  const Shape& shape() const { return shape_; }
  const std::vector<Beginning>& beginnings() const { return beginnings_; }

  State switched_on();
  bool act(const State& state, Action action, Next& next);

  /// All are Halted and have heard so of each other.
  bool halted_for_all(const State& state);
  /// The goal of L1: in each group the same intent and the state that it names, the same in both. Somebody is down: the
  /// goal of F1, all others Halted.
  bool settled(const State& state) const;
  bool anybody_down(const State& state) const;
  bool all_running(const State& state) const;

  const handshake::Word& word(const State& state, std::size_t participant) const {
    return nodes_.word(word_of(state, participant));
  }
  /// What stands in a register; the state must have something there.
  const handshake::Word& word_in(const State& state, std::size_t channel) const {
    return nodes_.word(static_cast<WordId>(state.content(channel)));
  }
  const Letter& letter_in(const State& state, std::size_t channel) const {
    return nodes_.letter(static_cast<WordId>(state.content(channel)));
  }
  const Participant& participant(const State& state, std::size_t participant) const {
    return nodes_.participant(state.member(tree_.node_of(participant)), tree_.side_of(participant));
  }
  handshake::PublishedState state_of(const State& state, std::size_t participant) const;
  bool is_down(const State& state, std::size_t participant) const {
    return nodes_[state.member(tree_.node_of(participant))].down;
  }
  std::size_t value_count() const { return nodes_.size(); }
  std::size_t word_count() const { return nodes_.word_count() - 1; }

 private:
  void list_actions();
  void make_beginnings();

  bool change(const State& state, Action action, Next& next);
  bool forge(const State& state, Action action, Next& next);
  bool is_deaf(const State& state, std::size_t participant, std::size_t peer) const;
  bool publish(const State& state, std::size_t channel, Next& next) const;
  bool sample(const State& state, std::size_t channel, Next& next);
  bool call(const State& state, Action action, Next& next);
  bool fault(const State& state, Action action, Next& next);
  bool restart(const State& state, std::size_t node, Next& next);
  bool expire(const State& state, Action action, bool peer_is_down, Next& next);
  /// False if nothing changes.
  bool step(std::size_t participant, TreeStimulus stimulus, Next& next);
  void watch(std::size_t node, std::uint32_t effects, Next& next);
  WordId word_of(const State& state, std::size_t participant) const;

  Query query_;
  TreeShape tree_;
  Shape shape_;
  TreeNodes nodes_;
  Interner<SmallObserver, HashOfObserver> observers_;
  Memo watched_;  ///< (observer, node, effects) -> (observer, violated)
  std::vector<Beginning> beginnings_;
};

}  // namespace takt::explore
