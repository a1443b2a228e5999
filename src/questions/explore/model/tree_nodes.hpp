// SPDX-License-Identifier: Apache-2.0
// All nodes that occur in an exploration of a tree, as numbers; the counterpart of members.hpp. A node is a
// participant, or two that are coupled (handshake::NestedParticipant). Each step is taken once by the handshake and
// then remembered.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <variant>
#include <vector>

#include "explore/model/hash_index.hpp"
#include "explore/model/members.hpp"
#include "explore/model/tree_shape.hpp"
#include "explore/properties/small_observer.hpp"
#include "handshake/nested_participant.hpp"

namespace takt::explore {

using NodeId = std::uint32_t;

constexpr std::size_t at(handshake::Side side) { return static_cast<std::size_t>(side); }

/// What happens to one of a node's participants.
struct TreeStimulus {
  handshake::Side side = handshake::Side::outer;
  handshake::Input::Kind kind = handshake::Input::Kind::finished;
  std::uint8_t what = 0;  ///< method or peer
  WordId word = no_word;
};

/// What one participant's part of a node's step means to whoever watches.
struct TreeEffect {
  handshake::Side side = handshake::Side::outer;
  Effect effect;
  constexpr bool operator==(const TreeEffect&) const = default;
};

/// All that follows from one input, in the order of the steps.
struct TreeEffects {
  std::uint8_t count = 0;
  std::array<TreeEffect, handshake::Coupling::most_steps + 1> each{};
  constexpr bool operator==(const TreeEffects&) const = default;
};

struct TreeStepped {
  NodeId node = 0;
  std::uint32_t effects = 0;  ///< 0: nothing to see
};

class TreeNodes {
 public:
  /// By side; a plain node has Outer only.
  struct Traits {
    std::array<WordId, 2> word{};  ///< what it publishes
    std::array<handshake::PublishedState, 2> state{handshake::PublishedState::Halted,
                                                   handshake::PublishedState::Halted};
    std::array<std::uint8_t, 2> calls{};  ///< methods that it accepts, by index
    std::array<std::uint8_t, 2> deaf{};   ///< peers whose words it takes for old ones
    std::uint32_t incarnation = 0;
    bool down = false;
  };

  explicit TreeNodes(const TreeShape& shape);

  NodeId fresh(std::size_t node, std::uint32_t incarnation);
  /// One that is down; it remembers only how often it was up.
  NodeId down(std::size_t node, std::uint32_t incarnation);

  const Traits& operator[](NodeId node) const { return traits_[node]; }
  std::size_t size() const { return traits_.size(); }
  TreeStepped step(NodeId node, const TreeStimulus& stimulus) {
    const std::uint64_t found = steps_.find(key_of(node, stimulus));
    return found != Memo::absent ? TreeStepped{static_cast<NodeId>(found), static_cast<std::uint32_t>(found >> 32)}
                                 : step_anew(node, stimulus);
  }
  const TreeEffects& effects(std::uint32_t id) const { return effects_[id]; }
  const handshake::Word& word(WordId word) const { return words_[word].word; }
  const Letter& letter(WordId word) const { return words_[word]; }
  /// One of the participants of a node.
  const Participant& participant(NodeId node, handshake::Side side) const;
  /// What a stranger may say as that side of a node.
  const std::vector<WordId>& forged(NodeId node, handshake::Side side);
  std::size_t word_count() const { return words_.size(); }

 private:
  using Nested = handshake::NestedParticipant<most_slaves, most_slaves>;
  struct Node {
    std::variant<Participant, Nested> value;
    bool down = false;
    bool operator==(const Node&) const = default;
  };
  struct HashOfNode {
    std::size_t operator()(const Node& node) const {
      return mixed(std::visit([](const auto& each) { return each.hash(); }, node.value) + (node.down ? 1 : 0));
    }
  };
  struct HashOfEffects {
    std::size_t operator()(const TreeEffects& effects) const;
  };

  static std::uint64_t key_of(NodeId node, const TreeStimulus& stimulus) {
    return std::uint64_t{node} << 32 | static_cast<std::uint64_t>(stimulus.kind) << 28 |
           static_cast<std::uint64_t>(stimulus.side) << 27 | std::uint64_t{stimulus.what} << 20 |
           std::uint64_t{stimulus.word};
  }
  handshake::Config config(std::size_t group, std::size_t index, std::uint32_t incarnation) const;
  Node made(std::size_t node, std::uint32_t incarnation) const;
  TreeStepped step_anew(NodeId node, const TreeStimulus& stimulus);
  NodeId intern(const Node& node);
  std::uint8_t calls_of(const Node& node, handshake::Side side) const;
  WordId intern_word(const Letter& letter);

  TreeShape shape_;
  Interner<Node, HashOfNode> nodes_;
  std::vector<Traits> traits_;
  Interner<Letter, HashOfLetter> words_;
  std::vector<std::array<std::vector<WordId>, 2>> forged_;  ///< by node and side; empty: not asked yet
  Interner<TreeEffects, HashOfEffects> effects_;
  Memo steps_;
};

}  // namespace takt::explore
