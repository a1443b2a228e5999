#include "explore/tree_chart.hpp"

#include "explore/retelling.hpp"
#include "explore/tree_model.hpp"

namespace takt::explore {
namespace {

class Teller {
 public:
  explicit Teller(const Question& question) : model_(question), tree_(model_.tree()) {}

  Chart tell(const Beginning& beginning, const Trace& trace) {
    Chart chart;
    for (std::size_t p = 0; p < tree_.participants(); ++p) chart.names.push_back(tree_.name(p));
    chart.width = 15;
    return retold(model_, std::move(chart), beginning, trace, [this](const State& state) { return states(state); }, [this](const State& state, Action action) { return told(state, action); });
  }

 private:
  std::vector<std::string> states(const State& state) const {
    std::vector<std::string> states;
    for (std::size_t p = 0; p < tree_.participants(); ++p)
      states.push_back(model_.is_down(state, p) ? down_state : std::string(handshake::name_of(model_.state_of(state, p))));
    return states;
  }
  std::string text(const handshake::Word& word, std::size_t sender) const {
    return text_of(word, tree_.name(tree_.number_of(tree_.group_of(sender), word.intent.origin)));
  }
  ChartStep told(const State& state, Action action) const {
    const ActionKind kind = action.kind;
    const bool of_channel = kind == ActionKind::send || kind == ActionKind::receive || kind == ActionKind::lose;
    const bool of_node = kind == ActionKind::crash || kind == ActionKind::restart;
    Happening it;
    it.kind = kind;
    it.method = action.what;
    ChartStep step;
    if (of_channel) {
      const TreeShape::Channel& ends = tree_.channel(action.who);
      it.from = tree_.name(ends.sender);
      it.to = tree_.name(ends.receiver);
      it.word = text(kind == ActionKind::send ? model_.word(state, ends.sender) : model_.word_in(state, action.who), ends.sender);
      if (kind == ActionKind::receive) step.arrow = {ends.sender, ends.receiver};
      else step.marked = {ends.sender};
    } else if (of_node) {
      it.who = tree_.node_name(action.who);
      it.comes_up = model_.is_down(state, tree_.participant_of(action.who, handshake::Side::Outer));
      for (std::size_t p = 0; p < tree_.participants(); ++p)
        if (tree_.node_of(p) == action.who) step.marked.push_back(p);
    } else {
      it.who = tree_.name(action.who);
      if (kind == ActionKind::silence || kind == ActionKind::timeout) it.peer = tree_.name(tree_.peer_of(action.who, action.what));
      if (kind == ActionKind::forge) {
        const Letter letter = forgeries(model_.word(state, action.who), tree_.size(tree_.group_of(action.who)) - 1)[action.what];
        it.word = text(letter.word, action.who);
        it.is_overtaking = letter.ahead;
      }
      step.marked = {action.who};
    }
    step.sentence = sentence(it);
    return step;
  }

  TreeModel model_;
  const TreeShape& tree_;
};

}  // namespace

Chart chart_of_tree(const Question& question, const Beginning& beginning, const Trace& trace) { return Teller(question).tell(beginning, trace); }

}  // namespace takt::explore
