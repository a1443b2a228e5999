// SPDX-License-Identifier: Apache-2.0
// A group with roles on sampled registers: candidates announce themselves, the master binds the roles to them, and all
// may leave, crash and come back in every order. The counterpart of group_model.hpp, whose State it fills: stations
// instead of participants, a notice in each channel.
//
// The group may be nested: then its master is the last slave of an outer group without roles. What an action names is a
// seat: 0 the master, c + 1 candidate c, then the participants of the outer group, of which the last one is the
// master's node, too. All others are stations of their own. Each candidate has four channels: what it announces, and
// what it says in its role; the table of bindings, and what the master says; each outer slave has two, its words and
// those of its master. At the master the time-outs of roles come before those of announcements.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "explore/model/action_list.hpp"
#include "explore/model/model.hpp"
#include "explore/model/stations.hpp"
#include "handshake/role_observer.hpp"

namespace takt::explore {

/// Who watches whoever has the roles.
struct RolesObserver {
  SmallObserver group;
  std::array<handshake::RoleObserver, most_explored_roles> roles{};
  bool operator==(const RolesObserver&) const = default;
};

class RolesModel : public ActionList, public ToldApart {
 public:
  enum class Channel : std::uint8_t { announcement, word_up, table, word_down };
  static constexpr std::size_t channels_of_candidate = 4;

  explicit RolesModel(const Query& query);

  const Query& query() const { return query_; }
  const Shape& shape() const { return shape_; }
  const std::vector<Beginning>& beginnings() const { return beginnings_; }

  State switched_on();
  bool act(const State& state, Action action, Next& next);

  /// The goal of L1: whoever announces itself is known, roles are filled if they can be, whoever has one knows it, and
  /// all have done what was asked for last; a Start at rest ends in Running. The master is down: the goal of F1, all
  /// others Halted.
  bool settled(const State& state) const;
  bool anybody_down(const State& state) const;
  bool all_running(const State& state) const;
  std::size_t value_count() const { return stations_.size(); }
  std::size_t word_count() const { return stations_.notice_count() - 1; }

  std::size_t stations() const { return query_.candidates + 1U; }
  std::size_t roles() const { return query_.roles(); }
  /// Of the outer group besides the master's node.
  std::size_t outsiders() const { return query_.nested() ? query_.slaves : std::size_t{0}; }
  std::size_t all_stations() const { return stations() + outsiders(); }
  std::size_t seats() const { return all_stations() + (query_.nested() ? 1 : 0); }
  bool is_outer(std::size_t seat) const { return seat >= stations(); }
  std::size_t outer_seat(std::size_t participant) const { return stations() + participant; }
  std::size_t station_of(std::size_t seat) const { return seat == all_stations() ? 0 : seat; }
  /// Where the outermost group is started.
  std::size_t leader() const { return query_.nested() ? outer_seat(0) : 0; }
  bool is_down(const State& state, std::size_t station) const {
    return station == 0           ? master(state).down
           : station < stations() ? node(state, station - 1).down
                                  : stations_.outsider(state.member(station)).down;
  }
  /// Who sits there; null at a candidate without a role.
  const Participant* participant_at(const State& state, std::size_t seat) const;
  const Stations::Master& master(const State& state) const { return stations_.master(state.member(0)); }
  const handshake::Binder& binder(const State& state) const { return stations_.binder(state.member(0)); }
  const Stations::Node& node(const State& state, std::size_t candidate) const {
    return stations_.node(state.member(candidate + 1));
  }
  /// Of the master, or of whoever has a role, Halted if nobody has; then those of the outer group.
  handshake::PublishedState state_of(const State& state, std::size_t participant) const;
  /// What stands in a register, and what would be put there.
  const Notice& notice_in(const State& state, std::size_t channel) const {
    return stations_.notice(state.content(channel));
  }
  const Notice& notice_for(const State& state, std::size_t channel) { return stations_.notice(said(state, channel)); }

  std::size_t channels() const { return channels_of_candidate * query_.candidates + 2 * outsiders(); }
  bool is_outer_channel(std::size_t channel) const { return channel >= channels_of_candidate * query_.candidates; }
  std::size_t outer_channel(std::size_t slave, bool up) const {
    return channels_of_candidate * query_.candidates + 2 * (slave - 1) + (up ? 0 : 1);
  }
  /// Seats.
  std::size_t sender_of(std::size_t channel) const;
  std::size_t receiver_of(std::size_t channel) const;
  static std::size_t candidate_of(std::size_t channel) { return channel / channels_of_candidate; }
  static Channel kind_of(std::size_t channel) { return static_cast<Channel>(channel % channels_of_candidate); }
  static bool is_up(std::size_t channel) { return kind_of(channel) <= Channel::word_up; }
  static std::size_t channel(std::size_t candidate, Channel kind) {
    return candidate * channels_of_candidate + static_cast<std::size_t>(kind);
  }

 private:
  struct HashOfObserver {
    std::size_t operator()(const RolesObserver& observer) const;
  };
  void list_actions();
  void make_beginnings();
  bool change(const State& state, Action action, Next& next);
  bool publish(const State& state, std::size_t channel, Next& next);
  bool receive(const State& state, std::size_t channel, Next& next);
  bool expire(const State& state, Action action, bool is_silent, Next& next);
  bool crash(const State& state, std::size_t station, Next& next);
  bool restart(const State& state, std::size_t station, Next& next);
  bool forget(std::size_t channel, Next& next) const;
  /// False if nothing changes.
  bool step(std::size_t seat, Happens what, std::size_t which, NoticeId notice, Next& next);
  bool expire_outside(const State& state, Action action, bool is_silent, Next& next);
  std::size_t number_of(std::size_t participant) const {
    return participant + (query_.nested() ? query_.slaves + 1U : 0U);
  }  ///< of the group with roles, in the tree
  bool is_outside_steady_state(const State& state, handshake::PublishedState goal) const;
  bool watch(std::uint32_t events, Next& next);
  void judge_holders(Next& next) const;
  NoticeId said(const State& state, std::size_t channel);
  bool at_rest(const State& state);
  /// The participant of the life to which the role is bound; null if it does not know yet, or is gone.
  const Participant* holder(const State& state, std::size_t role) const;
  bool is_heard(const State& state, std::size_t role) const;
  bool can_be_filled(const State& state, std::size_t role, unsigned taken) const;
  bool knows_candidates(const State& state) const;

  Query query_;
  Shape shape_;
  Stations stations_;
  handshake::GroupTree group_;  ///< the master and the roles, and around them the outer group
  Interner<RolesObserver, HashOfObserver> observers_;
  std::vector<Beginning> beginnings_;
};

}  // namespace takt::explore
