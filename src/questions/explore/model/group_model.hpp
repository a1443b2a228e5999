// SPDX-License-Identifier: Apache-2.0
// The group on its abstract network: which actions there are, and what each makes of a state. README.md says the rules.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "explore/model/action.hpp"
#include "explore/model/action_list.hpp"
#include "explore/model/contents.hpp"
#include "explore/model/members.hpp"
#include "explore/model/model.hpp"
#include "explore/model/query.hpp"
#include "explore/model/recording.hpp"
#include "explore/model/renaming.hpp"
#include "explore/model/state.hpp"
#include "explore/model/wiring.hpp"
#include "explore/properties/property.hpp"
#include "explore/properties/small_observer.hpp"

namespace takt::explore {

class GroupModel : public ActionList {
 public:
  explicit GroupModel(const Query& query);
  GroupModel(const GroupModel&) = delete;
  GroupModel& operator=(const GroupModel&) = delete;

  const Query& query() const { return query_; }
  const std::vector<Beginning>& beginnings() const { return beginnings_; }
  const Wiring& wiring() const { return wiring_; }
  const Shape& shape() const { return shape_; }

  /// False if the action is not possible, or changes nothing.
  bool act(const State& state, Action action, Next& next);
  /// The same for all states that differ in the names of slaves only.
  State canonical(const State& state);

  /// All are Halted and have heard so of each other: nothing of before is left that anybody could still hear or
  /// believe.
  bool halted_for_all(const State& state);
  /// The goal of L1 (somebody down: of F1) holds here.
  bool settled(const State& state) const;
  bool anybody_down(const State& state) const;
  bool all_running(const State& state) const;
  bool with_symmetry() const { return query_.symmetry && query_.slaves > 1; }
  bool symmetric() const { return members_.symmetric(); }
  /// On registers states with somebody who can go round (recurrence.hpp).
  Recurrence recurrence();
  bool recurs(const State& state) const;

  handshake::PublishedState state_of(const State& state, std::size_t participant) const {
    return members_[state.member(participant)].state;
  }
  Members& members() { return members_; }
  const Members& members() const { return members_; }
  std::size_t value_count() const { return members_.size(); }
  std::size_t word_count() const { return members_.word_count() - 1; }
  std::size_t observer_count() const { return observers_.size(); }
  const Recording& recording(const State& state, std::size_t participant) const {
    return recordings_[state.recording(participant)];
  }

 private:
  void list_actions();
  void make_beginnings();
  State switched_on();

  bool change(const State& state, Action action, Next& next);
  bool forge(const State& state, std::size_t as, std::size_t what, Next& next);
  bool initialised(const State& state, std::size_t participant, Next& next);
  bool call(const State& state, std::size_t participant, std::size_t method, Next& next);
  bool finish(const State& state, std::size_t participant, Next& next);
  bool fault(const State& state, Action action, Next& next);
  bool crash(const State& state, std::size_t participant, Next& next);
  bool restart(const State& state, std::size_t participant, Next& next);
  bool expire(const State& state, std::size_t participant, std::size_t peer, bool peer_is_down, Next& next);

  // replays.cpp
  std::uint32_t hearers_of(std::size_t sender) const;
  void set_recording(std::size_t sender, Recording recording, Next& next);
  bool publish_and_record(const State& state, std::size_t channel, Next& next);
  bool sample_recorded(const State& state, std::size_t channel, Next& next);
  bool deliver_recorded(const State& state, std::size_t channel, std::size_t place, WordId word, Next& next);
  bool replay(const State& state, std::size_t channel, std::size_t back, Next& next);
  bool change_key(const State& state, std::size_t participant, Next& next);
  void empty_standing(std::size_t channel, Next& next);

  // network_registers.cpp and network_channels.cpp
  bool act_on_registers(const State& state, Action action, Next& next);
  bool act_on_channels(const State& state, Action action, Next& next);
  bool put_into_channel(const State& state, std::size_t channel, WordId word, Next& next);
  bool publish_to_register(const State& state, std::size_t channel, Next& next) const;
  bool sample(const State& state, std::size_t channel, Next& next);
  bool sample_late(const State& state, Next& next);
  bool empty_register(const State& state, std::size_t channel, Next& next);
  bool keep_copy(const State& state, std::size_t channel, bool overtaken, Next& next) const;
  bool publish_to_channel(const State& state, std::size_t channel, Next& next);
  bool hear(const State& state, std::size_t channel, std::size_t position, Next& next);
  bool change_content(const State& state, Action action, Next& next);
  bool forget_channel(std::size_t channel, Next& next);
  void outdate(std::size_t participant, Next& next);
  bool is_up_to_date(const State& state, std::size_t channel) const;

  bool step(std::size_t participant, const Stimulus& stimulus, Next& next, bool& data_counts);
  bool step(std::size_t participant, const Stimulus& stimulus, Next& next) {
    bool data_counts = false;
    return step(participant, stimulus, next, data_counts);
  }
  void end_round(const State& state, Next& next);
  void watch(std::size_t participant, std::uint16_t effect, Next& next);
  std::uint32_t intern_observer(const SmallObserver& observer);
  bool at_rest(const State& state) const;
  bool is_down(const State& state, std::size_t participant) const { return members_[state.member(participant)].down; }
  std::uint64_t sort_key(const State& state, std::size_t slave) const;
  State renamed(const State& state, std::size_t renaming) const;
  bool names_matter(const State& state) const;

  Query query_;
  Wiring wiring_;
  Shape shape_;
  Renamings renamings_;
  Members members_;
  Contents contents_;
  handshake::GroupTree group_;
  Interner<SmallObserver, HashOfObserver> observers_;
  Interner<Recording, HashOfRecording> recordings_;  ///< with the fault `replay`; 0: nothing was said
  std::vector<std::uint32_t> renamed_observer_;      ///< by observer and renaming
  std::vector<bool> goes_round_;                     ///< by member
  Memo watched_;                                     ///< (observer, participant, effect) -> (observer, violated)
  std::vector<std::uint8_t> renamed_channel_;        ///< by channel and renaming
  std::vector<Beginning> beginnings_;
};

}  // namespace takt::explore
