// SPDX-License-Identifier: Apache-2.0
#include "explore/model/tree_nodes.hpp"

#include "sim/check.hpp"

namespace takt::explore {

using handshake::Input;
using handshake::NestedOutputs;
using handshake::PublishedState;
using handshake::Side;
using handshake::Word;

namespace {

template <class Value>
const auto& of_side(const Value& value, Side side) {
  if constexpr (requires { value.outer(); }) {
    return side == Side::outer ? value.outer() : value.inner();
  } else {
    return value;
  }
}

/// Both kinds of nodes take steps alike.
NestedOutputs take(Participant& value, Side side, const Input& input) {
  NestedOutputs all;
  all.count = 1;
  all.steps[0].side = side;
  all.steps[0].outputs = value.step(input);
  all.steps[0].after = value.word();
  return all;
}
template <class Nested>
NestedOutputs take(Nested& value, Side side, const Input& input) {
  return value.step(side, input);
}

}  // namespace

TreeNodes::TreeNodes(const TreeShape& shape) : shape_(shape) {
  words_.append(Letter{});         // no_word
  effects_.intern(TreeEffects{});  // nothing
}

handshake::Config TreeNodes::config(std::size_t group, std::size_t index, std::uint32_t incarnation) const {
  return {handshake::Variant::robust,
          index == 0 ? handshake::Role::master : handshake::Role::slave,
          static_cast<std::uint8_t>(index),
          static_cast<std::uint8_t>(shape_.size(group) - 1),
          incarnation,
          handshake::Subscription::star,
          false};
}

auto TreeNodes::made(std::size_t node, std::uint32_t incarnation) const -> Node {
  if (shape_.is_nested(node)) return {Nested(config(0, node, incarnation), config(1, 0, incarnation)), false};
  const std::size_t participant = shape_.participant_of(node, Side::outer);
  return {Participant(config(shape_.group_of(participant), shape_.index_of(participant), incarnation)), false};
}

const Participant& TreeNodes::participant(NodeId node, Side side) const {
  return std::visit([side](const auto& value) -> const Participant& { return of_side(value, side); },
                    nodes_[node].value);
}

NodeId TreeNodes::fresh(std::size_t node, std::uint32_t incarnation) { return intern(made(node, incarnation)); }

/// A plain slave of each group may have the same value; whose it is says its place in the state.
NodeId TreeNodes::down(std::size_t node, std::uint32_t incarnation) {
  Node value = made(node, incarnation);
  value.down = true;
  return intern(value);
}

TreeStepped TreeNodes::step_anew(NodeId id, const TreeStimulus& stimulus) {
  Node node = nodes_[id];
  std::array<Word, 2> before{};
  TreeEffects effects;
  std::visit(
      [&](auto& value) {
        for (const Side side : {Side::outer, Side::inner}) before[at(side)] = of_side(value, side).word();
        const PublishedState first = before[at(stimulus.side)].state;
        const auto& stepping = of_side(value, stimulus.side);
        const Input input = input_of(stimulus.kind, stimulus.what, words_[stimulus.word], false, stepping.intent().run);
        const NestedOutputs outputs = take(value, stimulus.side, input);
        for (const NestedOutputs::One& one : outputs.all()) {
          TreeEffect effect;
          effect.side = one.side;
          effect.effect = effect_of(before[at(one.side)], one.after, one.outputs);
          before[at(one.side)] = one.after;
          if (one.side == Side::inner && one.outputs.raised &&
              one.outputs.raised_kind == handshake::IntentKind::Start) {
            effect.effect.started_run = one.after.intent.run;
            effect.effect.outer_run = before[at(Side::outer)].intent.run;
          }
          if (effect.effect != Effect{}) effects.each[effects.count++] = effect;
        }
        PropertySet more = judged(input, outputs.steps[0].outputs, first, of_side(value, stimulus.side));
        const Side other = stimulus.side == Side::outer ? Side::inner : Side::outer;
        if (stimulus.kind == Input::Kind::peer_silent && of_side(value, other).state() != PublishedState::Halted)
          more.insert(Property::F1);
        if (more.bits != 0) {
          if (effects.count == 0) effects.each[effects.count++].side = stimulus.side;
          effects.each[0].effect.properties.bits |= more.bits;
        }
        value.forget_last_transition();
      },
      node.value);
  const TreeStepped stepped{intern(node), effects_.intern(effects)};
  steps_.insert(key_of(id, stimulus), std::uint64_t{stepped.node} | std::uint64_t{stepped.effects} << 32);
  return stepped;
}

NodeId TreeNodes::intern(const Node& node) {
  const NodeId id = nodes_.intern(node);
  if (id < traits_.size()) return id;
  Traits traits;
  traits.down = node.down;
  std::visit(
      [&](const auto& value) {
        traits.incarnation = of_side(value, Side::outer).config().incarnation;
        for (const Side side : {Side::outer, Side::inner}) {
          traits.word[at(side)] = intern_word({of_side(value, side).word(), false});
          traits.state[at(side)] = of_side(value, side).state();
          for (std::size_t peer = 0; peer < of_side(value, side).peer_count(); ++peer)
            if (of_side(value, side).has_heard_beyond(peer, usual_sequence))
              traits.deaf[at(side)] = static_cast<std::uint8_t>(traits.deaf[at(side)] | 1U << peer);
          traits.calls[at(side)] = node.down ? std::uint8_t{0} : calls_of(node, side);
        }
      },
      node.value);
  traits_.push_back(traits);
  return id;
}

/// What it accepts is tried once.
std::uint8_t TreeNodes::calls_of(const Node& node, Side side) const {
  std::uint8_t calls = 0;
  for (const program::MethodInfo& method : program::methods) {
    Node tried = node;
    const bool accepted = std::visit(
        [&](auto& value) {
          return program::is_good(take(value, side, Input::command(method.method)).steps[0].outputs.status);
        },
        tried.value);
    if (accepted) calls = static_cast<std::uint8_t>(calls | 1U << program::index_of(method.method));
  }
  return calls;
}

const std::vector<WordId>& TreeNodes::forged(NodeId node, Side side) {
  if (forged_.size() <= node) forged_.resize(nodes_.size());
  std::vector<WordId>& words = forged_[node][at(side)];
  if (!words.empty()) return words;
  const auto said = std::visit(
      [&](const auto& value) { return std::pair(of_side(value, side).word(), of_side(value, side).config().slaves); },
      nodes_[node].value);
  for (const Letter& letter : forgeries(said.first, said.second)) words.push_back(intern_word(letter));
  return words;
}

WordId TreeNodes::intern_word(const Letter& letter) {
  const std::uint32_t id = words_.intern(letter);
  TAKT_CHECK(id <= 0xFFFF, "an exploration has at most 65535 different words: allow fewer calls or faults");
  return static_cast<WordId>(id);
}

std::size_t TreeNodes::HashOfEffects::operator()(const TreeEffects& effects) const {
  std::uint64_t digest = effects.count;
  for (std::size_t i = 0; i < effects.count; ++i) {
    const TreeEffect& each = effects.each[i];
    digest = mixed(digest ^ HashOfEffect{}(each.effect)) + static_cast<std::uint64_t>(each.side);
  }
  return digest;
}

}  // namespace takt::explore
