// SPDX-License-Identifier: Apache-2.0
#include "explore/model/group_model.hpp"

#include <algorithm>
#include <utility>

#include "explore/model/beginnings.hpp"
#include "explore/model/forged_words.hpp"
#include "explore/properties/recurrence.hpp"
#include "sim/check.hpp"

namespace takt::explore {

using handshake::Input;
using handshake::PublishedState;
using handshake::Variant;
using program::Method;

namespace {

/// A recording is not renamed.
Query without_symmetry_of_recordings(Query query) {
  query.symmetry = query.symmetry && !query.has_recordings();
  return query;
}

}  // namespace

GroupModel::GroupModel(const Query& query)
    : query_(without_symmetry_of_recordings(query)),
      wiring_(query),
      shape_(query, wiring_.size()),
      renamings_(query.slaves, query_.symmetry),
      members_(query_, renamings_),
      contents_(members_, renamings_),
      group_(query.slaves + 1U) {
  const bool is_star = query.subscription == handshake::Subscription::star;
  TAKT_CHECK(query.slaves >= 1 && query.slaves <= (is_star ? most_slaves : most_slaves_all_to_all),
             "a group to explore is small");
  TAKT_CHECK(query.commands <= most_commands && query.fault_budget <= most_faults, "budgets are small");
  TAKT_CHECK(query.variant == Variant::robust || !query.faults.contains(Fault::forge),
             "the words of paper say too little to forge much");
  TAKT_CHECK(query.has_recordings() || (!query.is_signed && query.key_changes == 0),
             "signatures and keys are about what a stranger replays");
  TAKT_CHECK(
      !query.has_recordings() || (query.variant == Variant::robust && query.network == Network::registers &&
                                  !query.faults.contains(Fault::duplicate) && !query.faults.contains(Fault::reorder) &&
                                  !query.faults.contains(Fault::forge)),
      "replays are explored with robust, on registers, and stand for duplicates and late words");
  TAKT_CHECK(query.key_changes <= (query.is_signed ? most_key_changes : 0),
             "only signed messages have keys, which change seldom");
  TAKT_CHECK(query.capacity >= 1 && query.capacity <= most_capacity, "channels are short");
  for (std::size_t c = 0; c < wiring_.size(); ++c)
    for (std::size_t r = 0; r < renamings_.size(); ++r)
      renamed_channel_.push_back(static_cast<std::uint8_t>(
          wiring_.channel(renamings_[r].to[wiring_.sender(c)], renamings_[r].to[wiring_.receiver(c)])));
  recordings_.intern(Recording{});
  list_actions();
  make_beginnings();
}

void GroupModel::list_actions() {
  const auto participants = static_cast<std::uint8_t>(query_.slaves + 1);
  const std::size_t places = query_.network == Network::channels ? query_.capacity : 1;
  const auto each_channel = [&](ActionKind kind, std::size_t count) {
    for (std::size_t c = 0; c < wiring_.size(); ++c)
      for (std::size_t place = 0; place < count; ++place) add(kind, c, place);
  };
  const auto each_peer = [&](ActionKind kind) {
    for (std::size_t c = 0; c < wiring_.size(); ++c) add(kind, wiring_.receiver(c), wiring_.peer(c));
  };
  const auto each_participant = [&](ActionKind kind) {
    for (std::uint8_t i = 0; i < participants; ++i) add(kind, i, 0);
  };
  const bool strays = query_.faults.contains(Fault::duplicate) || query_.faults.contains(Fault::reorder);
  each_channel(ActionKind::send, 1);
  each_channel(ActionKind::receive, 1);
  if (strays && query_.network == Network::channels) each_channel(ActionKind::deliver_late, places);
  if (strays && query_.network == Network::registers) add(ActionKind::deliver_late, 0, 0);
  each_participant(ActionKind::initialised);
  if (query_.faults.contains(Fault::crash) || query_.faults.contains(Fault::forge)) each_peer(ActionKind::silence);
  end_network();
  for (std::uint8_t i = 0; i < participants; ++i)
    for (std::uint8_t m = 0; m < program::methods.size(); ++m) add(ActionKind::call, i, m);
  if (query_.finishes) each_participant(ActionKind::finish);
  end_calls();
  if (query_.faults.contains(Fault::loss)) each_channel(ActionKind::lose, places);
  if (query_.faults.contains(Fault::duplicate)) each_channel(ActionKind::duplicate, 1);
  if (query_.faults.contains(Fault::reorder)) each_channel(ActionKind::reorder, 1);
  if (query_.faults.contains(Fault::crash)) each_participant(ActionKind::crash);
  begin_free();
  if (query_.faults.contains(Fault::restart)) each_participant(ActionKind::restart);
  if (query_.key_changes != 0) each_participant(ActionKind::change_key);
  end_free();
  if (query_.faults.contains(Fault::timeout)) each_peer(ActionKind::timeout);
  if (query_.faults.contains(Fault::forge))
    for (std::size_t i = 0; i < participants; ++i)
      for (std::size_t word = 0; word < most_forgeries; ++word) add(ActionKind::forge, i, word);
  if (query_.has_recordings()) each_channel(ActionKind::replay, most_recorded);
}

void GroupModel::make_beginnings() {
  const std::size_t participants = query_.slaves + 1U;
  for (const Rest& rest : rests()) {
    Opening opening(*this, switched_on(), rest.name);
    for (const Method method : rest.calls) {
      opening.call(method);
      opening.settle(participants, wiring_.size(), 6);
    }
    opening.keep(participants, rest.state, beginnings_);
    if (query_.beginnings == Beginnings::switched_on) break;
  }
}

State GroupModel::switched_on() {
  State state(shape_);
  for (std::size_t i = 0; i <= query_.slaves; ++i) state.set_member(i, members_.fresh(i, 1));
  state.set_observer(intern_observer(SmallObserver(query_.variant, group_)));
  return state;
}

bool GroupModel::act(const State& state, Action action, Next& next) {
  if (!change(state, action, next)) return false;
  if (query_.faults.contains(Fault::forge)) judge_forgery(*this, state, action, next);
  return true;
}

/// Nothing of before is left that anybody could still hear or believe.
bool GroupModel::halted_for_all(const State& state) {
  if (members_[state.member(0)].state != PublishedState::Halted || !at_rest(state)) return false;
  for (std::size_t i = 0; i <= query_.slaves; ++i)
    if (members_[state.member(i)].deaf != 0) return false;
  for (std::size_t c = 0; c < wiring_.size(); ++c) {
    const WordId word = members_[state.member(wiring_.sender(c))].word;
    const MemberId receiver = state.member(wiring_.receiver(c));
    if (members_.step(receiver, {Input::Kind::received, wiring_.peer(c), word, false}).member != receiver) return false;
  }
  return true;
}

bool GroupModel::change(const State& state, Action action, Next& next) {
  switch (action.kind) {
    case ActionKind::send:
    case ActionKind::receive:
    case ActionKind::deliver_late:
      return query_.network == Network::registers ? act_on_registers(state, action, next)
                                                  : act_on_channels(state, action, next);
    case ActionKind::initialised:
      return initialised(state, action.who, next);
    case ActionKind::silence:
      return expire(state, action.who, action.what, true, next);
    case ActionKind::call:
      return call(state, action.who, action.what, next);
    case ActionKind::finish:
      return finish(state, action.who, next);
    default:
      return fault(state, action, next);
  }
}

/// A participant that is down may always come up again, and keys change; everything else costs a fault.
bool GroupModel::fault(const State& state, Action action, Next& next) {
  const bool is_free =
      action.kind == ActionKind::change_key || (action.kind == ActionKind::restart && is_down(state, action.who));
  if (!is_free && state.faults_left() == 0) return false;
  bool possible = false;
  switch (action.kind) {
    case ActionKind::crash:
      possible = crash(state, action.who, next);
      break;
    case ActionKind::restart:
      possible = restart(state, action.who, next);
      break;
    case ActionKind::change_key:
      possible = change_key(state, action.who, next);
      break;
    case ActionKind::replay:
      possible = replay(state, action.who, action.what, next);
      break;
    case ActionKind::forge:
      possible = forge(state, action.who, action.what, next);
      break;
    case ActionKind::timeout:
      possible = expire(state, action.who, action.what, false, next);
      break;
    default:
      possible = query_.network == Network::registers ? act_on_registers(state, action, next)
                                                      : act_on_channels(state, action, next);
      break;
  }
  if (possible && !is_free) next.state.set_faults_left(state.faults_left() - 1);
  return possible;
}

bool GroupModel::initialised(const State& state, std::size_t participant, Next& next) {
  if (members_[state.member(participant)].state != PublishedState::HaltedInit || is_down(state, participant))
    return false;
  next = {state, {}};
  return step(participant, {Input::Kind::initialised}, next);
}

bool GroupModel::call(const State& state, std::size_t participant, std::size_t method, Next& next) {
  if (state.commands_left() == 0 || ((members_[state.member(participant)].calls >> method) & 1U) == 0) return false;
  next = {state, {}};
  end_round(state, next);
  next.state.set_commands_left(state.commands_left() - 1);
  step(participant, {Input::Kind::command, static_cast<std::uint8_t>(method)}, next);
  return true;
}

bool GroupModel::finish(const State& state, std::size_t participant, Next& next) {
  const Members::Traits& member = members_[state.member(participant)];
  if (state.commands_left() == 0 || member.down || member.state != PublishedState::Running) return false;
  next = {state, {}};
  end_round(state, next);
  next.state.set_commands_left(state.commands_left() - 1);
  step(participant, {Input::Kind::finished}, next);
  return true;
}

/// `paper`: what was asked before the group came to rest does not count any more.
void GroupModel::end_round(const State& state, Next& next) {
  if (query_.variant != Variant::paper || !at_rest(state)) return;
  SmallObserver observer = observers_[state.observer()];
  observer.at_rest();
  next.state.set_observer(intern_observer(observer));
}

/// One packet, which all hear who hear that participant.
bool GroupModel::forge(const State& state, std::size_t as, std::size_t what, Next& next) {
  const std::vector<WordId>& words = members_.forged(state.member(as));
  if (what >= words.size()) return false;
  const WordId word = words[what];
  next = {state, {}};
  bool possible = false;
  for (std::size_t c = 0; c < wiring_.size(); ++c)
    if (wiring_.sender(c) == as) possible = put_into_channel(state, c, word, next) || possible;
  return possible;
}

bool GroupModel::crash(const State& state, std::size_t participant, Next& next) {
  if (is_down(state, participant)) return false;
  next = {state, {}};
  next.state.set_member(participant, members_.down(participant, members_.incarnation(state.member(participant))));
  return true;
}

bool GroupModel::restart(const State& state, std::size_t participant, Next& next) {
  const std::uint32_t incarnation = members_.incarnation(state.member(participant));
  next = {state, {}};
  // `paper` does not publish incarnations, so its lives need not be told apart.
  next.state.set_member(participant,
                        members_.fresh(participant, query_.variant == Variant::paper ? incarnation : incarnation + 1));
  SmallObserver observer = observers_[state.observer()];
  observer.on_restart(participant);
  next.state.set_observer(intern_observer(observer));
  return true;
}

bool GroupModel::expire(const State& state, std::size_t participant, std::size_t peer, bool peer_is_down, Next& next) {
  const std::size_t other = peer_participant(participant, peer);
  const bool is_deaf = peer_is_down && ((members_[state.member(participant)].deaf >> peer) & 1U) != 0;
  if ((is_down(state, other) != peer_is_down && !is_deaf) || is_down(state, participant)) return false;
  next = {state, {}};
  bool changed = step(participant, {Input::Kind::peer_silent, static_cast<std::uint8_t>(peer)}, next);
  // Silence means that nothing of the peer is under way any more.
  if (is_down(state, other)) changed = forget_channel(wiring_.channel(other, participant), next) || changed;
  return changed || next.properties.bits != 0;
}

bool GroupModel::step(std::size_t participant, const Stimulus& stimulus, Next& next, bool& data_counts) {
  const MemberId before = next.state.member(participant);
  const Stepped stepped = members_.step(before, stimulus);
  data_counts = stepped.data_counts;
  next.state.set_member(participant, stepped.member);
  if (stepped.effect != 0) watch(participant, stepped.effect, next);
  return stepped.member != before;
}

/// Shows a step to the observer.
void GroupModel::watch(std::size_t participant, std::uint16_t effect, Next& next) {
  const Effect& seen = members_.effect(effect);
  const std::uint64_t key = std::uint64_t{next.state.observer()} << 20 | std::uint64_t{participant} << 16 | effect;
  std::uint64_t found = watched_.find(key);
  if (found == Memo::absent) {
    SmallObserver observer = observers_[next.state.observer()];
    const PropertySet violated = observer.on_effect(group_, participant, seen);
    found = std::uint64_t{intern_observer(observer)} | std::uint64_t{violated.bits} << 32;
    watched_.insert(key, found);
  }
  next.state.set_observer(static_cast<std::uint32_t>(found));
  next.properties.bits |= static_cast<std::uint32_t>(found >> 32) | seen.properties.bits;
  if (query_.variant == Variant::paper && seen.begins_round()) outdate(participant, next);
}

std::uint32_t GroupModel::intern_observer(const SmallObserver& observer) {
  const std::uint32_t id = observers_.intern(observer);
  const std::size_t count = renamings_.size();
  if ((id + 1U) * count <= renamed_observer_.size()) return id;
  std::vector<std::uint32_t> images;
  for (std::size_t r = 0; r < count; ++r) images.push_back(observers_.intern(observer.renamed(renamings_[r])));
  renamed_observer_.resize(observers_.size() * count, 0);
  for (std::size_t r = 0; r < count; ++r)
    for (std::size_t s = 0; s < count; ++s) renamed_observer_[images[r] * count + s] = images[renamings_.then(r, s)];
  return id;
}

bool GroupModel::anybody_down(const State& state) const {
  for (std::size_t i = 0; i <= query_.slaves; ++i)
    if (is_down(state, i)) return true;
  return false;
}

bool GroupModel::all_running(const State& state) const {
  for (std::size_t i = 0; i <= query_.slaves; ++i)
    if (members_[state.member(i)].state != PublishedState::Running || is_down(state, i)) return false;
  return true;
}

/// Nothing is under way: all are in one state, and every register says so.
bool GroupModel::at_rest(const State& state) const {
  const PublishedState first = members_[state.member(0)].state;
  if (first == PublishedState::HaltedInit || state.late() != Late::none) return false;
  for (std::size_t i = 0; i <= query_.slaves; ++i)
    if (is_down(state, i) || members_[state.member(i)].state != first) return false;
  for (std::size_t c = 0; c < wiring_.size(); ++c)
    if (!is_up_to_date(state, c)) return false;
  return true;
}

bool GroupModel::settled(const State& state) const {
  if (anybody_down(state)) {
    for (std::size_t i = 0; i <= query_.slaves; ++i)
      if (!is_down(state, i) && members_[state.member(i)].state != PublishedState::Halted) return false;
    return true;
  }
  const handshake::Word& first = members_.word(members_[state.member(0)].word);
  for (std::size_t i = 1; i <= query_.slaves; ++i) {
    const handshake::Word& word = members_.word(members_[state.member(i)].word);
    if (word.state != first.state || !(word.intent == first.intent)) return false;
  }
  if (state.promised() && first.state != PublishedState::Running) return false;
  if (query_.variant == Variant::robust) return first.state == handshake::goal_of(first.intent.kind);
  return first.state != PublishedState::HaltedInit && observers_[state.observer()].asked(first.state);
}

Recurrence GroupModel::recurrence() {
  if (query_.network == Network::channels) return Recurrence::all;
  goes_round_ = members_that_go_round(members_, query_.slaves);
  return std::find(goes_round_.begin(), goes_round_.end(), true) == goes_round_.end() ? Recurrence::none
                                                                                      : Recurrence::some;
}

bool GroupModel::recurs(const State& state) const {
  for (std::size_t i = 0; i <= query_.slaves; ++i)
    if (goes_round_[state.member(i)]) return true;
  return false;
}

}  // namespace takt::explore
