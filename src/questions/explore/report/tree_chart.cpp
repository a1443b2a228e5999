// SPDX-License-Identifier: Apache-2.0
#include "explore/model/tree_model.hpp"
#include "explore/report/model_chart.hpp"

namespace takt::explore {
namespace {

struct TreeWords {
  static constexpr std::size_t width = 15;
  explicit TreeWords(const Query& query) : model(query), tree(model.tree()), channels(tree.channels()) {}
  TreeModel model;
  const TreeShape& tree;
  std::size_t channels;

  std::vector<std::string> names() const {
    std::vector<std::string> names;
    for (std::size_t p = 0; p < tree.participants(); ++p) names.push_back(tree.name(p));
    return names;
  }
  std::vector<std::string> states(const State& state) const {
    std::vector<std::string> states;
    for (std::size_t p = 0; p < tree.participants(); ++p)
      states.push_back(model.is_down(state, p) ? down_state
                                               : std::string(handshake::name_of(model.state_of(state, p))));
    return states;
  }
  std::vector<std::vector<std::string>> origins() const {
    std::vector<std::vector<std::string>> origins(tree.participants());
    for (std::size_t p = 0; p < tree.participants(); ++p)
      for (std::size_t i = 0; i < tree.size(tree.group_of(p)); ++i)
        origins[p].push_back(tree.name(tree.number_of(tree.group_of(p), i)));
    return origins;
  }
  std::vector<std::pair<std::size_t, std::size_t>> pairs() const {
    std::vector<std::pair<std::size_t, std::size_t>> pairs;
    for (std::size_t c = 0; c < channels; ++c) pairs.emplace_back(tree.channel(c).receiver, tree.channel(c).sender);
    return pairs;
  }
  const Participant* participant(const State& state, std::size_t column) const {
    return model.is_down(state, column) ? nullptr : &model.participant(state, column);
  }
  std::optional<std::size_t> peer(const State& state, std::size_t who, std::size_t of) const {
    if (model.is_down(state, who)) return std::nullopt;
    return tree.channel(tree.channel_between(of, who)).peer;
  }
  std::size_t speaker(std::size_t channel) const { return tree.channel(channel).sender; }
  Hearing heard(const State& state, std::size_t channel) const {
    return {tree.channel(channel).receiver, speaker(channel), model.letter_in(state, channel)};
  }
  std::string text(const handshake::Word& word, std::size_t sender) const {
    return text_of(word, tree.name(tree.number_of(tree.group_of(sender), word.intent.origin)));
  }
  ChartStep step(const State& state, Action action) const {
    const ActionKind kind = action.kind;
    const bool of_channel = kind == ActionKind::send || kind == ActionKind::receive || kind == ActionKind::lose;
    const bool of_node = kind == ActionKind::crash || kind == ActionKind::restart;
    Happening it;
    it.kind = kind;
    it.method = action.what;
    ChartStep made;
    if (of_channel) {
      const TreeShape::Channel& ends = tree.channel(action.who);
      it.from = tree.name(ends.sender);
      it.to = tree.name(ends.receiver);
      it.word = text(kind == ActionKind::send ? model.word(state, ends.sender) : model.word_in(state, action.who),
                     ends.sender);
      if (kind == ActionKind::receive)
        made.arrow = {ends.sender, ends.receiver};
      else
        made.marked = {ends.sender};
    } else if (of_node) {
      it.who = tree.node_name(action.who);
      it.comes_up = model.is_down(state, tree.participant_of(action.who, handshake::Side::outer));
      for (std::size_t p = 0; p < tree.participants(); ++p)
        if (tree.node_of(p) == action.who) made.marked.push_back(p);
    } else {
      it.who = tree.name(action.who);
      if (kind == ActionKind::silence || kind == ActionKind::timeout)
        it.peer = tree.name(tree.peer_of(action.who, action.what));
      if (kind == ActionKind::forge) {
        const Letter letter =
            forgeries(model.word(state, action.who), tree.size(tree.group_of(action.who)) - 1)[action.what];
        it.word = text(letter.word, action.who);
        it.is_overtaking = letter.ahead;
      }
      made.marked = {action.who};
    }
    made.sentence = sentence(it);
    return made;
  }
};

}  // namespace

Chart chart_of_tree(const Query& query, const Beginning& beginning, const Trace& trace) {
  return chart_with<TreeWords>(query, beginning, trace);
}

}  // namespace takt::explore
