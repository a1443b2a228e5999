// SPDX-License-Identifier: Apache-2.0
#include "explore/model/tree_model.hpp"

#include <optional>

#include "explore/model/beginnings.hpp"
#include "explore/model/forged_words.hpp"
#include "sim/check.hpp"

namespace takt::explore {

using handshake::Input;
using handshake::PublishedState;
using handshake::Side;
using program::Method;

namespace {

/// Nodes, registers, the observer and the budgets.
Shape shape_of(const TreeShape& tree) {
  Shape shape;
  shape.wide = true;
  shape.channels_at = static_cast<std::uint8_t>(tree.nodes());
  shape.observer_at = shape.late_at = static_cast<std::uint8_t>(tree.nodes() + tree.channels());
  shape.rest_at = static_cast<std::uint8_t>(shape.observer_at + 1);
  shape.words = static_cast<std::uint8_t>((shape.rest_at + 2U) / 2U * 2U);
  TAKT_CHECK(shape.words <= State::most_words, "a tree to explore is small");
  return shape;
}

}  // namespace

TreeModel::TreeModel(const Query& query) : query_(query), tree_(query), shape_(shape_of(tree_)), nodes_(tree_) {
  TAKT_CHECK(query.variant == handshake::Variant::robust && query.subscription == handshake::Subscription::star &&
                 query.network == Network::registers,
             "trees are explored with robust in stars on registers");
  TAKT_CHECK(!query.faults.contains(Fault::duplicate) && !query.faults.contains(Fault::reorder),
             "no delayed copies in trees");
  list_actions();
  make_beginnings();
}

void TreeModel::list_actions() {
  const auto each_channel = [&](ActionKind kind) {
    for (std::size_t c = 0; c < tree_.channels(); ++c) add(kind, c, 0);
  };
  const auto each_peer = [&](ActionKind kind) {
    for (std::size_t c = 0; c < tree_.channels(); ++c) add(kind, tree_.channel(c).receiver, tree_.channel(c).peer);
  };
  each_channel(ActionKind::send);
  each_channel(ActionKind::receive);
  for (std::size_t p = 0; p < tree_.participants(); ++p) add(ActionKind::initialised, p, 0);
  if (query_.faults.contains(Fault::crash) || query_.faults.contains(Fault::forge) || query_.joining)
    each_peer(ActionKind::silence);
  end_network();
  for (std::size_t p = 0; p < tree_.participants(); ++p)
    for (std::size_t m = 0; m < program::methods.size(); ++m) add(ActionKind::call, p, m);
  if (query_.finishes)
    for (std::size_t p = 0; p < tree_.participants(); ++p) add(ActionKind::finish, p, 0);
  end_calls();
  if (query_.faults.contains(Fault::loss)) each_channel(ActionKind::lose);
  for (std::size_t node = 0; node < tree_.nodes(); ++node) {
    if (query_.faults.contains(Fault::crash)) add(ActionKind::crash, node, 0);
    if (query_.faults.contains(Fault::restart) || node == tree_.joining_node()) add(ActionKind::restart, node, 0);
  }
  if (query_.faults.contains(Fault::timeout)) each_peer(ActionKind::timeout);
  end_free();  // there are many words to forge, and with no fault left none of them is possible
  if (query_.faults.contains(Fault::forge))
    for (std::size_t p = 0; p < tree_.participants(); ++p)
      for (std::size_t word = 0; word < most_forgeries; ++word) add(ActionKind::forge, p, word);
}

State TreeModel::switched_on() {
  State state(shape_);
  for (std::size_t node = 0; node < tree_.nodes(); ++node)
    state.set_member(node, node == tree_.joining_node() ? nodes_.down(node, 0) : nodes_.fresh(node, 1));
  state.set_observer(observers_.intern(SmallObserver(handshake::Variant::robust, tree_.tree())));
  return state;
}

/// One that joins is down when all others are switched on; in the other rests it has joined.
void TreeModel::make_beginnings() {
  for (const Rest& rest : rests()) {
    const bool joins = query_.joining && !rest.calls.empty();
    Opening opening(*this, switched_on(),
                    rest.name + std::string(query_.joining && !joins ? ", but for the one that joins" : ""));
    if (joins) opening.take({ActionKind::restart, static_cast<std::uint8_t>(tree_.joining_node()), 0});
    for (const Method method : rest.calls) {
      opening.call(method);
      opening.settle(tree_.participants(), tree_.channels(), 12);
    }
    opening.keep(tree_.participants(), rest.state, beginnings_);
    if (query_.beginnings == Beginnings::switched_on) break;
  }
}

bool TreeModel::act(const State& state, Action action, Next& next) {
  if (!change(state, action, next)) return false;
  if (query_.faults.contains(Fault::forge)) judge_forgery(*this, state, action, next);
  return true;
}

/// Nothing of before is left that anybody could still hear or believe.
bool TreeModel::halted_for_all(const State& state) {
  if (anybody_down(state)) return false;
  for (std::size_t p = 0; p < tree_.participants(); ++p)
    if (state_of(state, p) != PublishedState::Halted) return false;
  for (std::size_t c = 0; c < tree_.channels(); ++c) {
    const TreeShape::Channel& ends = tree_.channel(c);
    const WordId word = word_of(state, ends.sender);
    if (state.content(c) != word || is_deaf(state, ends.receiver, ends.peer)) return false;
    const NodeId node = state.member(tree_.node_of(ends.receiver));
    if (nodes_.step(node, {tree_.side_of(ends.receiver), Input::Kind::received, ends.peer, word}).node != node)
      return false;
  }
  return true;
}

bool TreeModel::is_deaf(const State& state, std::size_t participant, std::size_t peer) const {
  return ((nodes_[state.member(tree_.node_of(participant))].deaf[at(tree_.side_of(participant))] >> peer) & 1U) != 0;
}

/// One packet, which all hear who hear that participant.
bool TreeModel::forge(const State& state, Action action, Next& next) {
  const std::vector<WordId>& words = nodes_.forged(state.member(tree_.node_of(action.who)), tree_.side_of(action.who));
  if (action.what >= words.size()) return false;
  const WordId word = words[action.what];
  next = {state, {}};
  for (std::size_t c = 0; c < tree_.channels(); ++c)
    if (tree_.channel(c).sender == action.who) next.state.set_content(c, word);
  return true;
}

bool TreeModel::change(const State& state, Action action, Next& next) {
  switch (action.kind) {
    case ActionKind::send:
      return publish(state, action.who, next);
    case ActionKind::receive:
      return sample(state, action.who, next);
    case ActionKind::initialised:
      if (state_of(state, action.who) != PublishedState::HaltedInit || is_down(state, action.who)) return false;
      next = {state, {}};
      return step(action.who, {Side::outer, Input::Kind::initialised, 0, no_word}, next);
    case ActionKind::silence:
      return expire(state, action, true, next);
    case ActionKind::call:
    case ActionKind::finish:
      return call(state, action, next);
    default:
      return fault(state, action, next);
  }
}

bool TreeModel::publish(const State& state, std::size_t channel, Next& next) const {
  const std::size_t sender = tree_.channel(channel).sender;
  const WordId word = word_of(state, sender);
  if (is_down(state, sender) || state.content(channel) == word) return false;
  next = {state, {}};
  next.state.set_content(channel, word);
  return true;
}

bool TreeModel::sample(const State& state, std::size_t channel, Next& next) {
  const TreeShape::Channel& ends = tree_.channel(channel);
  const auto word = static_cast<WordId>(state.content(channel));
  if (word == no_word || is_down(state, ends.receiver)) return false;
  next = {state, {}};
  return step(ends.receiver, {Side::outer, Input::Kind::received, ends.peer, word}, next);
}

bool TreeModel::call(const State& state, Action action, Next& next) {
  if (state.commands_left() == 0 || is_down(state, action.who)) return false;
  const TreeNodes::Traits& node = nodes_[state.member(tree_.node_of(action.who))];
  const bool is_call = action.kind == ActionKind::call;
  const bool accepted = is_call ? ((node.calls[at(tree_.side_of(action.who))] >> action.what) & 1U) != 0
                                : state_of(state, action.who) == PublishedState::Running;
  if (!accepted) return false;
  next = {state, {}};
  next.state.set_commands_left(state.commands_left() - 1);
  step(action.who,
       {Side::outer, is_call ? Input::Kind::command : Input::Kind::finished, static_cast<std::uint8_t>(action.what),
        no_word},
       next);
  return true;
}

/// Whoever is down may always come up again; everything else costs a fault.
bool TreeModel::fault(const State& state, Action action, Next& next) {
  const bool of_node = action.kind == ActionKind::crash || action.kind == ActionKind::restart;
  const bool node_down = of_node && nodes_[state.member(action.who)].down;
  const bool is_free = action.kind == ActionKind::restart && node_down;
  if (!is_free && state.faults_left() == 0) return false;
  bool possible = false;
  switch (action.kind) {
    case ActionKind::lose:
      possible = state.content(action.who) != no_word;
      next = {state, {}};
      next.state.set_content(action.who, no_word);
      break;
    case ActionKind::crash:
      possible = !node_down;
      next = {state, {}};
      if (possible)
        next.state.set_member(action.who, nodes_.down(action.who, nodes_[state.member(action.who)].incarnation));
      break;
    case ActionKind::restart:
      possible = (is_free || query_.faults.contains(Fault::restart)) && restart(state, action.who, next);
      break;
    case ActionKind::forge:
      possible = forge(state, action, next);
      break;
    case ActionKind::timeout:
      possible = expire(state, action, false, next);
      break;
    default:
      break;
  }
  if (possible && !is_free) next.state.set_faults_left(state.faults_left() - 1);
  return possible;
}

bool TreeModel::restart(const State& state, std::size_t node, Next& next) {
  next = {state, {}};
  next.state.set_member(node, nodes_.fresh(node, nodes_[state.member(node)].incarnation + 1));
  SmallObserver observer = observers_[state.observer()];
  observer.on_restart(tree_.participant_of(node, Side::outer));
  if (tree_.is_nested(node)) observer.on_restart(tree_.participant_of(node, Side::inner));
  next.state.set_observer(observers_.intern(observer));
  return true;
}

bool TreeModel::expire(const State& state, Action action, bool peer_is_down, Next& next) {
  const std::size_t other = tree_.peer_of(action.who, action.what);
  const bool deaf = peer_is_down && is_deaf(state, action.who, action.what);
  if ((is_down(state, other) != peer_is_down && !deaf) || is_down(state, action.who)) return false;
  next = {state, {}};
  bool changed =
      step(action.who, {Side::outer, Input::Kind::peer_silent, static_cast<std::uint8_t>(action.what), no_word}, next);
  const std::size_t channel = tree_.channel_between(other, action.who);
  if (is_down(state, other) &&
      state.content(channel) != no_word) {  // silence means that nothing of the peer is under way any more
    next.state.set_content(channel, no_word);
    changed = true;
  }
  return changed;
}

bool TreeModel::step(std::size_t participant, TreeStimulus stimulus, Next& next) {
  stimulus.side = tree_.side_of(participant);
  const std::size_t node = tree_.node_of(participant);
  const NodeId before = next.state.member(node);
  const TreeStepped stepped = nodes_.step(before, stimulus);
  next.state.set_member(node, stepped.node);
  if (stepped.effects != 0) watch(node, stepped.effects, next);
  return stepped.node != before || next.properties.bits != 0;
}

/// Shows a step to the observer.
void TreeModel::watch(std::size_t node, std::uint32_t effects, Next& next) {
  TAKT_CHECK(effects <= 0x0FFF'FFFF, "the effects of a step have 28 bits");
  const std::uint64_t key = std::uint64_t{next.state.observer()} << 32 | std::uint64_t{node} << 28 | effects;
  std::uint64_t found = watched_.find(key);
  if (found == Memo::absent) {
    SmallObserver observer = observers_[next.state.observer()];
    PropertySet seen;
    const TreeEffects& all = nodes_.effects(effects);
    for (std::size_t i = 0; i < all.count; ++i) {
      seen.bits |= all.each[i].effect.properties.bits;
      seen.bits |=
          observer.on_effect(tree_.tree(), tree_.participant_of(node, all.each[i].side), all.each[i].effect).bits;
    }
    found = std::uint64_t{observers_.intern(observer)} | std::uint64_t{seen.bits} << 32;
    watched_.insert(key, found);
  }
  next.state.set_observer(static_cast<std::uint32_t>(found));
  next.properties.bits |= static_cast<std::uint32_t>(found >> 32);
}

WordId TreeModel::word_of(const State& state, std::size_t participant) const {
  return nodes_[state.member(tree_.node_of(participant))].word[at(tree_.side_of(participant))];
}

PublishedState TreeModel::state_of(const State& state, std::size_t participant) const {
  return nodes_[state.member(tree_.node_of(participant))].state[at(tree_.side_of(participant))];
}

bool TreeModel::anybody_down(const State& state) const {
  for (std::size_t node = 0; node < tree_.nodes(); ++node)
    if (nodes_[state.member(node)].down) return true;
  return false;
}

bool TreeModel::all_running(const State& state) const {
  for (std::size_t p = 0; p < tree_.participants(); ++p)
    if (is_down(state, p) || state_of(state, p) != PublishedState::Running) return false;
  return true;
}

bool TreeModel::settled(const State& state) const {
  const bool down = anybody_down(state);
  const PublishedState goal = down ? PublishedState::Halted : handshake::goal_of(word(state, 0).intent.kind);
  if (!down && state.promised() && goal != PublishedState::Running) return false;
  for (std::size_t group = 0; group < tree_.groups(); ++group) {
    std::optional<handshake::Intent> intent;  // of the master
    for (std::size_t i = 0; i < tree_.size(group); ++i) {
      const std::size_t p = tree_.number_of(group, i);
      if (is_down(state, p)) continue;
      if (state_of(state, p) != goal) return false;
      if (!intent) intent = word(state, p).intent;
      if (!down && word(state, p).intent != *intent) return false;
    }
  }
  return true;
}

}  // namespace takt::explore
