// SPDX-License-Identifier: Apache-2.0
#include "explore/model/roles_model.hpp"

#include "explore/model/beginnings.hpp"
#include "sim/check.hpp"

namespace takt::explore {

using handshake::PublishedState;
using program::Method;

namespace {

handshake::GroupTree tree_of(const Query& query) {
  if (!query.nested()) return handshake::GroupTree(query.slaves + std::size_t{1});
  return handshake::GroupTree(
      {{query.slaves + std::size_t{1}, 0, 0}, {query.roles() + std::size_t{1}, 0, query.slaves}});
}

}  // namespace

RolesModel::RolesModel(const Query& query) : query_(query), stations_(query), group_(tree_of(query)) {
  TAKT_CHECK(query.slaves >= 1 && query.roles() <= most_explored_roles && query.candidates >= 1 &&
                 query.candidates <= most_explored_candidates,
             "a group to explore is small");
  TAKT_CHECK(query.variant == handshake::Variant::robust && query.subscription == handshake::Subscription::star &&
                 query.network == Network::registers && !query.is_tree(),
             "roles are explored with robust in stars on registers");
  TAKT_CHECK(!query.nested() || (query.slaves <= most_outer_slaves && query.candidates <= most_inner_candidates &&
                                 !query.starts_again),
             "a nested group to explore is small, and does not start itself");
  TAKT_CHECK(!query.faults.contains(Fault::duplicate) && !query.faults.contains(Fault::reorder) &&
                 !query.faults.contains(Fault::forge),
             "no delayed copies and no strangers with roles");
  shape_.wide = true;
  shape_.channels_at = static_cast<std::uint8_t>(all_stations());
  shape_.observer_at = shape_.late_at = static_cast<std::uint8_t>(all_stations() + channels());
  shape_.rest_at = static_cast<std::uint8_t>(shape_.observer_at + 1);
  shape_.words = static_cast<std::uint8_t>((shape_.rest_at + 2U) / 2U * 2U);
  TAKT_CHECK(shape_.words <= State::most_words, "a group to explore is small");
  list_actions();
  make_beginnings();
}

void RolesModel::list_actions() {
  const auto each_channel = [&](ActionKind kind) {
    for (std::size_t c = 0; c < channels(); ++c) add(kind, c);
  };
  const auto each_seat = [&](ActionKind kind) {
    for (std::size_t s = 0; s < seats(); ++s) add(kind, s);
  };
  const auto each_station = [&](ActionKind kind) {
    for (std::size_t s = 0; s < all_stations(); ++s) add(kind, s);
  };
  const auto each_time_out = [&](ActionKind kind) {
    for (std::size_t what = 0; what < roles() + query_.candidates; ++what) add(kind, 0, what);
    for (std::size_t s = 1; s < stations(); ++s) add(kind, s);
    for (std::size_t slave = 1; slave <= outsiders(); ++slave) {
      add(kind, outer_seat(0), slave - 1);
      add(kind, outer_seat(slave));
    }
  };
  each_channel(ActionKind::send);
  each_channel(ActionKind::receive);
  each_seat(ActionKind::initialised);
  each_time_out(ActionKind::silence);
  end_network();
  for (std::size_t s = 0; s < seats(); ++s)
    for (std::size_t m = 0; m < program::methods.size(); ++m) add(ActionKind::call, s, m);
  if (query_.finishes) each_seat(ActionKind::finish);
  for (std::size_t c = 0; c < query_.candidates; ++c) {
    add(ActionKind::join, c);
    add(ActionKind::leave, c);
  }
  end_calls();
  if (query_.faults.contains(Fault::restart)) each_station(ActionKind::restart);
  end_free();
  if (query_.faults.contains(Fault::crash)) each_station(ActionKind::crash);
  if (query_.faults.contains(Fault::loss)) each_channel(ActionKind::lose);
  if (query_.faults.contains(Fault::timeout)) each_time_out(ActionKind::timeout);
}

State RolesModel::switched_on() {
  State state(shape_);
  state.set_member(0, stations_.master(1, false));
  for (std::size_t c = 0; c < query_.candidates; ++c) state.set_member(c + 1, stations_.candidate(c, 1, false, false));
  for (std::size_t p = 0; p < outsiders(); ++p) state.set_member(stations() + p, stations_.outsider(p, 1, false));
  state.set_observer(observers_.intern({SmallObserver(handshake::Variant::robust, group_), {}}));
  return state;
}

/// Switched on, those who announce themselves from the start have not been heard yet; in the other rests all have
/// joined.
void RolesModel::make_beginnings() {
  const auto begun = [this](std::string name, std::uint8_t joined) {
    Opening opening(*this, switched_on(), std::move(name));
    for (std::uint8_t c = 0; c < query_.candidates; ++c)
      if (((joined >> c) & 1U) != 0) opening.take({ActionKind::join, c, 0});
    return opening;
  };
  begun("switched on", query_.joined).keep(1, PublishedState::Halted, beginnings_);
  if (query_.beginnings == Beginnings::switched_on) return;
  if (query_.joined != 0) begun("switched on, nobody has joined", 0).keep(1, PublishedState::Halted, beginnings_);
  constexpr int rounds = 12;
  for (const Rest& rest : rests()) {
    if (rest.calls.empty()) continue;  // it follows from the first
    Opening opening = begun(rest.name, 0xFF);
    opening.settle(seats(), channels(), rounds);
    for (const Method method : rest.calls) {
      opening.take({ActionKind::call, static_cast<std::uint8_t>(leader()),
                    static_cast<std::uint16_t>(program::index_of(method))});
      opening.settle(seats(), channels(), rounds);
    }
    opening.keep(group_.participants(), rest.state, beginnings_);
  }
}

bool RolesModel::act(const State& state, Action action, Next& next) {
  if (!change(state, action, next)) return false;
  judge_holders(next);
  if (is_network(action.kind)) return true;
  const bool is_start = action.kind == ActionKind::call && action.who == leader() &&
                        (!query_.nested() || binder(state).complete()) &&
                        program::methods[action.what].method == Method::Start;
  next.state.set_promised(is_start && at_rest(state));
  return true;
}

bool RolesModel::change(const State& state, Action action, Next& next) {
  next = {state, {}};
  const bool is_down_now = !is_network(action.kind) &&
                           (action.kind == ActionKind::crash || action.kind == ActionKind::restart) &&
                           is_down(state, action.who);
  const bool is_free = action.kind == ActionKind::restart && is_down_now;
  if (is_fault(action.kind)) {
    if (!is_free && state.faults_left() == 0) return false;
    if (!is_free) next.state.set_faults_left(state.faults_left() - 1);
  } else if (!is_network(action.kind)) {
    if (state.commands_left() == 0) return false;
    next.state.set_commands_left(state.commands_left() - 1);
  }
  switch (action.kind) {
    case ActionKind::send:
      return publish(state, action.who, next);
    case ActionKind::receive:
      return receive(state, action.who, next);
    case ActionKind::initialised: {
      const Participant* const participant = participant_at(state, action.who);
      if (is_down(state, station_of(action.who)) || participant == nullptr ||
          participant->state() != PublishedState::HaltedInit)
        return false;
      return step(action.who, Happens::initialised, 0, no_notice, next);
    }
    case ActionKind::silence:
      return expire(state, action, true, next);
    case ActionKind::timeout:
      return expire(state, action, false, next);
    case ActionKind::call:
      return !is_down(state, station_of(action.who)) && step(action.who, Happens::call, action.what, no_notice, next);
    case ActionKind::finish: {
      const Participant* const participant = participant_at(state, action.who);
      return participant != nullptr && participant->state() == PublishedState::Running &&
             !is_down(state, station_of(action.who)) && step(action.who, Happens::finished, 0, no_notice, next);
    }
    case ActionKind::join:
    case ActionKind::leave: {
      const handshake::Candidate& candidate = node(state, action.who).candidate;
      const bool is_there = candidate.announces() && !candidate.announcement().leaving;
      if (is_down(state, action.who + 1U) || is_there == (action.kind == ActionKind::join)) return false;
      return step(action.who + 1U, action.kind == ActionKind::join ? Happens::join : Happens::leave, 0, no_notice,
                  next);
    }
    case ActionKind::lose:
      return forget(action.who, next);
    case ActionKind::crash:
      return !is_down_now && crash(state, action.who, next);
    case ActionKind::restart:
      return restart(state, action.who, next);
    default:
      return false;
  }
}

std::size_t RolesModel::sender_of(std::size_t channel) const {
  if (!is_outer_channel(channel)) return is_up(channel) ? candidate_of(channel) + 1 : 0;
  const std::size_t i = channel - channels_of_candidate * query_.candidates;
  return outer_seat(i % 2 == 0 ? i / 2 + 1 : 0);
}
std::size_t RolesModel::receiver_of(std::size_t channel) const {
  if (!is_outer_channel(channel)) return is_up(channel) ? 0 : candidate_of(channel) + 1;
  const std::size_t i = channel - channels_of_candidate * query_.candidates;
  return outer_seat(i % 2 == 0 ? 0 : i / 2 + 1);
}

const Participant* RolesModel::participant_at(const State& state, std::size_t seat) const {
  if (seat == 0) return &master(state).participant;
  if (station_of(seat) == 0) return &*master(state).outer;
  if (is_outer(seat)) return &stations_.outsider(state.member(seat)).participant;
  return node(state, seat - 1).member ? &*node(state, seat - 1).member : nullptr;
}

NoticeId RolesModel::said(const State& state, std::size_t channel) {
  if (is_outer_channel(channel)) {
    const std::size_t seat = sender_of(channel);
    return station_of(seat) == 0 ? stations_.word_outside(state.member(0))
                                 : stations_.word_of_outsider(state.member(seat));
  }
  const StationId sender = state.member(is_up(channel) ? candidate_of(channel) + 1 : 0);
  switch (kind_of(channel)) {
    case Channel::announcement:
      return stations_.announcement(sender);
    case Channel::word_up:
      return stations_.word_of_node(sender);
    case Channel::table:
      return stations_.table(sender);
    case Channel::word_down:
      return stations_.word_of_master(sender);
  }
  return no_notice;
}

bool RolesModel::publish(const State& state, std::size_t channel, Next& next) {
  if (is_down(state, station_of(sender_of(channel)))) return false;
  const NoticeId notice = said(state, channel);
  if (notice == no_notice || notice == state.content(channel)) return false;
  next.state.set_content(channel, notice);
  return true;
}

bool RolesModel::receive(const State& state, std::size_t channel, Next& next) {
  const NoticeId notice = state.content(channel);
  const std::size_t receiver = receiver_of(channel);
  if (notice == no_notice || is_down(state, station_of(receiver))) return false;
  if (is_outer_channel(channel))
    return step(receiver, Happens::received, receiver == outer_seat(0) ? sender_of(channel) - outer_seat(1) : 0, notice,
                next);
  return step(receiver, Happens::received, is_up(channel) ? candidate_of(channel) : 0, notice, next);
}

/// Falls silent: who is down, announces itself no more, or has the role no more. Then nothing of it is under way.
bool RolesModel::expire(const State& state, Action action, bool is_silent, Next& next) {
  if (is_down(state, station_of(action.who))) return false;
  if (is_outer(action.who)) return expire_outside(state, action, is_silent, next);
  if (action.who != 0) {
    if (is_down(state, 0) != is_silent || !node(state, action.who - 1U).member) return false;
    const bool changed = step(action.who, Happens::master_silent, 0, no_notice, next);
    const bool forgotten =
        is_silent && (static_cast<unsigned>(forget(channel(action.who - 1U, Channel::table), next)) |
                      static_cast<unsigned>(forget(channel(action.who - 1U, Channel::word_down), next))) != 0;
    return changed || forgotten;
  }
  const bool of_role = action.what < roles();
  if (of_role && !binder(state).binding(action.what).bound()) return false;
  const std::size_t candidate = of_role ? binder(state).binding(action.what).candidate : action.what - roles();
  const bool is_gone = of_role ? holder(state, action.what) == nullptr
                               : is_down(state, candidate + 1) || !node(state, candidate).candidate.announces();
  if (is_gone != is_silent || (of_role && !is_heard(state, action.what))) return false;
  const bool changed = step(0, of_role ? Happens::role_silent : Happens::announcer_silent,
                            of_role ? action.what : candidate, no_notice, next);
  const bool forgotten =
      is_silent && forget(channel(candidate, of_role ? Channel::word_up : Channel::announcement), next);
  return changed || forgotten;
}

/// Of the outer group: of a slave at its master, or of that.
bool RolesModel::expire_outside(const State& state, Action action, bool is_silent, Next& next) {
  const bool at_master = action.who == outer_seat(0);
  const std::size_t other = at_master ? outer_seat(action.what + 1U) : outer_seat(0);
  if (is_down(state, station_of(other)) != is_silent) return false;
  const Happens what = station_of(action.who) == 0 ? Happens::master_silent : Happens::peer_silent;
  const bool changed = step(action.who, what, at_master ? action.what : 0, no_notice, next);
  const std::size_t slave = (at_master ? other : std::size_t{action.who}) - outer_seat(0);
  const bool forgotten = is_silent && forget(outer_channel(slave, at_master), next);
  return changed || forgotten;
}

bool RolesModel::forget(std::size_t channel, Next& next) const {
  if (next.state.content(channel) == no_notice) return false;
  next.state.set_content(channel, no_notice);
  return true;
}

bool RolesModel::crash(const State& state, std::size_t station, Next& next) {
  if (station == 0) {
    next.state.set_member(0, stations_.master(master(state).participant.config().incarnation, true));
    return true;
  }
  if (is_outer(station)) {
    next.state.set_member(
        station, stations_.outsider(station - stations(),
                                    stations_.outsider(state.member(station)).participant.config().incarnation, true));
    return true;
  }
  const Stations::Node before = node(state, station - 1);
  RolesObserver observer = observers_[state.observer()];
  if (before.member) {
    const std::size_t role = before.member->config().index - 1U;
    if (observer.roles[role].on_dropped({before.number, before.candidate.announcement().life}))
      observer.group.on_restart(number_of(role + 1));
  }
  next.state.set_observer(observers_.intern(observer));
  next.state.set_member(station, stations_.candidate(station - 1, before.candidate.announcement().life,
                                                     before.candidate.announces(), true));
  return true;
}

/// One that goes down and comes up at once loses what one that crashes loses.
bool RolesModel::restart(const State& state, std::size_t station, Next& next) {
  if (!is_down(state, station)) crash(state, station, next);
  if (station == 0) {
    RolesObserver observer = observers_[next.state.observer()];
    observer.group.on_restart(number_of(0));
    if (query_.nested()) observer.group.on_restart(query_.slaves);
    next.state.set_observer(observers_.intern(observer));
    next.state.set_member(0, stations_.master(master(state).participant.config().incarnation + 1, false));
  } else if (is_outer(station)) {
    RolesObserver observer = observers_[next.state.observer()];
    observer.group.on_restart(station - stations());
    next.state.set_observer(observers_.intern(observer));
    next.state.set_member(
        station,
        stations_.outsider(station - stations(),
                           stations_.outsider(state.member(station)).participant.config().incarnation + 1, false));
  } else {
    const handshake::Candidate& candidate = node(state, station - 1).candidate;
    const bool joined = candidate.announces();
    next.state.set_member(
        station, stations_.candidate(station - 1, handshake::next_life(candidate.announcement().life), joined, false));
  }
  return true;
}

bool RolesModel::step(std::size_t seat, Happens what, std::size_t which, NoticeId notice, Next& next) {
  const std::size_t station = station_of(seat);
  const StationId before = next.state.member(station);
  const Stations::Stepped stepped = seat == 0         ? stations_.step_master(before, what, which, notice)
                                    : !is_outer(seat) ? stations_.step_node(before, what, which, notice)
                                    : station == 0    ? stations_.step_outside(before, what, which, notice)
                                                      : stations_.step_outsider(before, what, which, notice);
  next.state.set_member(station, stepped.station);
  const bool refused = stepped.events != 0 && watch(stepped.events, next);
  // A call that is refused may still end the wish to start again; it costs a call as well.
  return stepped.station != before || (!refused && next.properties.bits != 0);
}

/// Shows a step to the observer. True if it was a call that is refused.
bool RolesModel::watch(std::uint32_t events, Next& next) {
  const RoleEvents& all = stations_.events(events);
  next.properties.bits |= all.properties.bits;
  if (all.each.empty()) return all.refused;
  RolesObserver observer = observers_[next.state.observer()];
  for (const RoleEvent& each : all.each) {
    if (each.is_outer || each.participant == 0) {
      next.properties.bits |=
          observer.group.on_effect(group_, each.is_outer ? each.participant : number_of(0), each.effect).bits;
      continue;
    }
    const std::size_t role = each.participant - 1U;
    handshake::RoleObserver& of_role = observer.roles[role];
    switch (each.kind) {
      case RoleEvent::Kind::bound: {
        const Participant* const before = holder(next.state, role);
        if (of_role.on_bound(each.self, before == nullptr ? std::nullopt : std::optional(before->state())).is_new)
          observer.group.on_restart(number_of(role + 1));
        break;
      }
      case RoleEvent::Kind::dropped:
        if (of_role.on_dropped(each.self)) observer.group.on_restart(number_of(role + 1));
        break;
      case RoleEvent::Kind::step:
        if (of_role.on_step(each.self, each.after))
          next.properties.bits |= observer.group.on_effect(group_, number_of(each.participant), each.effect).bits;
        break;
    }
  }
  next.state.set_observer(observers_.intern(observer));
  return all.refused;
}

/// Of those that live at most one says the words of a role that the master takes, and it is the one that has the role.
void RolesModel::judge_holders(Next& next) const {
  if (is_down(next.state, 0)) return;
  for (std::size_t role = 0; role < roles(); ++role) {
    const Binding& binding = binder(next.state).binding(role);
    if (!binding.bound()) continue;
    for (std::size_t c = 0; c < query_.candidates; ++c) {
      const Stations::Node& each = node(next.state, c);
      const bool counts =
          each.member && each.member->config().index == role + 1 &&
          each.member->config().incarnation == handshake::incarnation_of(binding.candidate, binding.life);
      if (counts && c != binding.candidate) next.properties.insert(Property::B1);
    }
  }
}

const Participant* RolesModel::holder(const State& state, std::size_t role) const {
  const Binding& binding = binder(state).binding(role);
  if (!binding.bound()) return nullptr;
  const Stations::Node& each = node(state, binding.candidate);
  const bool is_holder =
      each.member && each.member->config().index == role + 1 && each.candidate.announcement().life == binding.life;
  return is_holder ? &*each.member : nullptr;
}

/// A time-out runs from the first word on.
bool RolesModel::is_heard(const State& state, std::size_t role) const {
  for (std::size_t s = 0; s < handshake::published_state_count; ++s)
    if (master(state).participant.peer_heard_in(role, handshake::published_state_at(s))) return true;
  return false;
}

PublishedState RolesModel::state_of(const State& state, std::size_t participant) const {
  if (participant == 0) return master(state).participant.state();
  if (participant > roles()) return participant_at(state, outer_seat(participant - roles() - 1))->state();
  const Participant* const each = holder(state, participant - 1);
  return each == nullptr ? PublishedState::Halted : each->state();
}

bool RolesModel::anybody_down(const State& state) const {
  if (is_down(state, 0)) return true;
  for (std::size_t station = stations(); station < all_stations(); ++station)
    if (is_down(state, station)) return true;
  return false;
}

bool RolesModel::all_running(const State& state) const {
  if (anybody_down(state)) return false;
  for (std::size_t p = 0; p < group_.participants(); ++p)
    if (state_of(state, p) != PublishedState::Running) return false;
  return true;
}

/// From this role on each can have a candidate of its own that is there; `taken`: a set of candidates.
bool RolesModel::can_be_filled(const State& state, std::size_t role, unsigned taken) const {
  if (role == roles()) return true;
  for (std::size_t c = 0; c < query_.candidates; ++c) {
    const bool offers = ((query_.offers[c] >> role) & 1U) != 0;
    if (offers && ((taken >> c) & 1U) == 0 && !node(state, c).down && node(state, c).candidate.announces() &&
        can_be_filled(state, role + 1, taken | 1U << c))
      return true;
  }
  return false;
}

/// Nobody is to be let go, whoever announces itself is known and nobody else is, and whoever believes to have a role
/// has it.
bool RolesModel::knows_candidates(const State& state) const {
  for (std::size_t c = 0; c < query_.candidates; ++c) {
    const Stations::Node& each = node(state, c);
    const bool is_there = !each.down && each.candidate.announces();
    if ((is_there && each.candidate.announcement().leaving) ||
        binder(state).present(static_cast<std::uint8_t>(c)) != is_there)
      return false;
    if (each.member && holder(state, each.member->config().index - 1U) != &*each.member) return false;
  }
  return true;
}

/// All of the outer group who live are in that state; if nobody is down, with the intent of its master.
bool RolesModel::is_outside_steady_state(const State& state, PublishedState goal) const {
  for (std::size_t p = 0; p <= outsiders() && query_.nested(); ++p) {
    const Participant& each = *participant_at(state, outer_seat(p));
    if (is_down(state, station_of(outer_seat(p)))) continue;
    if (each.state() != goal ||
        (!anybody_down(state) && each.intent() != participant_at(state, outer_seat(0))->intent()))
      return false;
  }
  return true;
}

bool RolesModel::settled(const State& state) const {
  const Participant& leader = master(state).participant;
  if (anybody_down(state)) {
    if (!is_outside_steady_state(state, PublishedState::Halted) ||
        (!is_down(state, 0) && leader.state() != PublishedState::Halted))
      return false;
    for (std::size_t c = 0; c < query_.candidates; ++c)
      if (node(state, c).member && node(state, c).member->state() != PublishedState::Halted) return false;
    return true;
  }
  const bool complete = binder(state).complete();
  if (!knows_candidates(state) || complete != can_be_filled(state, 0, 0)) return false;
  const Participant& outermost = *participant_at(state, this->leader());
  const PublishedState goal = complete ? handshake::goal_of(outermost.intent().kind) : PublishedState::Halted;
  if (!is_outside_steady_state(state, goal) || leader.state() != goal ||
      (state.promised() && goal != PublishedState::Running))
    return false;
  if (complete && goal == PublishedState::Halted && !outermost.may_start()) return false;
  for (std::size_t role = 0; role < roles(); ++role) {
    const Participant* const each = holder(state, role);
    if (each == nullptr ? binder(state).binding(role).bound()
                        : each->state() != goal || each->intent() != leader.intent())
      return false;
  }
  return true;
}

/// Settled, and nothing of before is left that anybody could still hear.
bool RolesModel::at_rest(const State& state) {
  if (anybody_down(state) || !settled(state)) return false;
  for (std::size_t c = 0; c < channels(); ++c)
    if (state.content(c) != no_notice && state.content(c) != said(state, c)) return false;
  // In the outer group a restart is noticed by its first word; a candidate that restarts is bound anew.
  for (std::size_t c = channels_of_candidate * query_.candidates; c < channels(); ++c) {
    Next heard{state, {}};
    if (state.content(c) == no_notice || receive(state, c, heard)) return false;
  }
  return true;
}

std::size_t RolesModel::HashOfObserver::operator()(const RolesObserver& observer) const {
  std::uint64_t digest = observer.group.hash();
  for (const handshake::RoleObserver& each : observer.roles)
    digest = mixed(digest ^ (std::uint64_t{each.binding().candidate} << 40 | std::uint64_t{each.binding().life} << 8 |
                             handshake::index_of(each.state()) << 1 | (each.is_awaited() ? 1U : 0U)));
  return digest;
}

}  // namespace takt::explore
