// SPDX-License-Identifier: Apache-2.0
// Nested groups without a network: the test says which word is delivered when.
#pragma once

#include <gtest/gtest.h>

#include <string>
#include <variant>
#include <vector>

#include "handshake/nested_participant.hpp"
#include "handshake/observer.hpp"
#include "handshake/reaction.hpp"

namespace takt::handshake {

/// A word under way within a group, with process data if its sender is Running.
struct TreeMessage {
  std::size_t group = 0;
  std::size_t from = 0;
  std::size_t to = 0;
  Word word;
  std::uint16_t sequence = 0;
  std::uint32_t sent_in = 0;
};

class Tree {
 public:
  using Plain = Participant<4>;
  using Nested = NestedParticipant<4, 4>;

  explicit Tree(std::vector<TreeGroup> groups)
      : observer(Variant::robust, GroupTree(std::move(groups))), reactions(shape().participants()) {
    places_.resize(shape().participants());
    for (std::size_t g = 0; g < shape().groups(); ++g)
      for (std::size_t p = 0; p < shape().size(g); ++p) {
        Place& place = places_[shape().number_of(g, p)];
        place = {g, p, 0, Side::outer};
        if (g != 0 && p == 0) {  // the node is there already, as a slave of the outer group
          const TreeGroup& group = shape().group(g);
          place.node = at(group.outer, group.outer_index).node;
          place.side = Side::inner;
          inner_group_[place.node] = g;
          continue;
        }
        place.node = nodes_.size();
        nodes_.push_back({});
        inner_group_.push_back(0);
        node_place_.push_back(shape().number_of(g, p));
        incarnation_.push_back(1);
      }
    pending_.resize(places_.size());
    sequence_.resize(places_.size());
    for (std::size_t n = 0; n < nodes_.size(); ++n) make(n);
  }

  const GroupTree& shape() const { return observer.tree(); }
  std::size_t groups() const { return shape().groups(); }
  std::size_t size(std::size_t group) const { return shape().size(group); }
  std::size_t participants() const { return places_.size(); }
  std::size_t nodes() const { return nodes_.size(); }
  std::pair<std::size_t, std::size_t> place(std::size_t number) const {
    return {places_[number].group, places_[number].index};
  }

  const Plain& member(std::size_t group, std::size_t i) const {
    const Place& place = at(group, i);
    if (const auto* plain = std::get_if<Plain>(&nodes_[place.node])) return *plain;
    const Nested& nested = std::get<Nested>(nodes_[place.node]);
    return place.side == Side::outer ? nested.outer() : nested.inner();
  }

  /// One step; what the participant itself has put out, not what followed on the other side of its node.
  Outputs step(std::size_t group, std::size_t i, const Input& input) {
    const Place place = at(group, i);
    if (auto* plain = std::get_if<Plain>(&nodes_[place.node])) {
      const Outputs outputs = plain->step(input);
      note(shape().number_of(group, i), outputs, plain->word());
      return outputs;
    }
    Nested& nested = std::get<Nested>(nodes_[place.node]);
    const NestedOutputs all = nested.step(place.side, input);
    const Place& outside = places_[node_place_[place.node]];
    for (const NestedOutputs::One& one : all.all())
      note(one.side == Side::outer ? shape().number_of(outside.group, outside.index)
                                   : shape().number_of(inner_group_[place.node], 0),
           one.outputs, one.after);
    return input.kind == Input::Kind::initialised ? Outputs{} : all.steps[0].outputs;
  }
  program::StatusCode call(std::size_t group, std::size_t i, program::Method method) {
    return step(group, i, Input::command(method)).status;
  }

  bool initialising(std::size_t number) const { return pending_[number].under_way; }
  void initialised(std::size_t number) {
    const std::uint32_t run = pending_[number].run;
    pending_[number] = {};
    step(places_[number].group, places_[number].index, Input::initialised(run));
  }

  TreeMessage message(std::size_t group, std::size_t from, std::size_t to) {
    return {group,
            from,
            to,
            member(group, from).word(),
            ++sequence_[shape().number_of(group, from)],
            observer.sending_run(shape().number_of(group, from))};
  }
  void deliver(const TreeMessage& message) {
    const std::size_t peer = member(message.group, message.to).peer_of(message.from);
    const bool ignored = step(message.group, message.to, Input::received(peer, message.word, message.sequence)).ignored;
    if (message.sent_in != 0 && !ignored && member(message.group, message.to).process_data_counts(peer))
      observer.on_process_data(shape().number_of(message.group, message.from),
                               shape().number_of(message.group, message.to), message.sent_in);
  }
  void notify_all(std::size_t group, std::size_t from) {
    for (std::size_t peer = 0; peer < member(group, from).peer_count(); ++peer)
      deliver(message(group, from, member(group, from).participant_of(peer)));
  }
  /// Everybody's initialisation ends and everybody publishes once.
  void round() {
    for (std::size_t n = 0; n < participants(); ++n) {
      if (initialising(n)) initialised(n);
      notify_all(places_[n].group, places_[n].index);
    }
  }
  void rounds(int count) {
    for (int i = 0; i < count; ++i) round();
  }
  /// The node of a participant is new, in both its groups.
  void restart(std::size_t node) {
    ++incarnation_[node];
    make(node);
    for (std::size_t n = 0; n < participants(); ++n) {
      if (places_[n].node != node) continue;
      sequence_[n] = 0;
      pending_[n] = {};
      observer.on_restart(n);
      reactions.on_restart(n, now);
    }
  }
  std::size_t node_of(std::size_t number) const { return places_[number].node; }

  bool all_in(PublishedState state) const {
    for (const Place& each : places_)
      if (member(each.group, each.index).state() != state) return false;
    return true;
  }
  /// L1: within each group all know the same intent and are in the state that it names; it is the same state in all
  /// groups.
  bool agreed() const {
    for (const Place& each : places_)
      if (member(each.group, each.index).intent() != member(each.group, 0).intent()) return false;
    return all_in(goal_of(member(0, 0).intent().kind));
  }

  std::string describe() const {
    std::string text;
    for (const Place& each : places_) {
      const Word word = member(each.group, each.index).word();
      text += "  group " + std::to_string(each.group) + " participant " + std::to_string(each.index) + " " +
              std::string(name_of(word.state)) + " intent " + std::to_string(word.intent.number) + "/" +
              std::string(name_of(word.intent.kind)) + "/" + std::to_string(word.intent.origin) + "/" +
              std::to_string(word.intent.run) + " run " + std::to_string(word.run) + "\n";
    }
    for (const Violation& each : observer.violations())
      text += "  " + std::string(name_of(each.invariant)) + (each.of_tree ? " of the tree" : "") + ": group " +
              std::to_string(each.group) + " participant " + std::to_string(each.participant) + " " +
              std::string(text_of(each.finding)) + "\n";
    return text;
  }

  Observer observer;
  TreeReactions reactions;
  sim::TrueTime now;
  std::string journal;

 private:
  struct Place {
    std::size_t group = 0;
    std::size_t index = 0;
    std::size_t node = 0;
    Side side = Side::outer;
  };
  struct Pending {
    bool under_way = false;
    std::uint32_t run = 0;
  };
  const Place& at(std::size_t group, std::size_t i) const { return places_[shape().number_of(group, i)]; }
  Config config(std::size_t group, std::size_t i, std::uint32_t incarnation) const {
    return {Variant::robust,
            i == 0 ? Role::master : Role::slave,
            static_cast<std::uint8_t>(i),
            static_cast<std::uint8_t>(size(group) - 1),
            incarnation,
            Subscription::star,
            false};
  }
  void make(std::size_t node) {
    const Place& place = places_[node_place_[node]];
    const std::size_t inner = inner_group_[node];
    const Config outer = config(place.group, place.index, incarnation_[node]);
    if (inner == 0)
      nodes_[node].emplace<Plain>(outer);
    else
      nodes_[node].emplace<Nested>(outer, config(inner, 0, incarnation_[node]));
  }
  void note(std::size_t number, const Outputs& outputs, const Word& after) {
    const Place& place = places_[number];
    observer.on_step(number, outputs, after);
    reactions.on_step(number, outputs, now);
    for (const StateChange& change : outputs.changes())
      journal +=
          std::to_string(place.group) + "." + std::to_string(place.index) + ":" + std::string(name_of(change.to)) + " ";
    if (outputs.begin_initialisation) pending_[number] = {true, outputs.initialisation_run};
    if (after.state != PublishedState::HaltedInit) pending_[number] = {};
  }

  std::vector<Place> places_;  // by participant number
  std::vector<std::variant<std::monostate, Plain, Nested>> nodes_;
  std::vector<std::size_t> inner_group_;    // by node; 0: none
  std::vector<std::size_t> node_place_;     // by node: the participant that it is outside
  std::vector<std::uint32_t> incarnation_;  // by node
  std::vector<Pending> pending_;            // by participant number
  std::vector<std::uint16_t> sequence_;
};

}  // namespace takt::handshake
