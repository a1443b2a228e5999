#include "explore/tree_chart.hpp"

#include <algorithm>

#include "explore/tree_model.hpp"
#include "sim/check.hpp"

namespace takt::explore {
namespace {

constexpr std::size_t margin = 6;
constexpr std::size_t column = 15;

std::string padded(std::string text, std::size_t width) {
  if (text.size() < width) text.resize(width, ' ');
  return text;
}
std::string trimmed(std::string line) {
  line.erase(line.find_last_not_of(' ') + 1);
  return line + "\n";
}

class Drawing {
 public:
  explicit Drawing(const Question& question) : model_(question), tree_(model_.tree()) {}

  std::string draw(const Beginning& beginning, const Trace& trace) {
    std::string text(margin, ' ');
    for (std::size_t p = 0; p < tree_.participants(); ++p) text += padded(tree_.name(p), column);
    text = trimmed(text);
    State state = model_.switched_on();
    Next next;
    // Numbers of states belong to one model, so the beginning is gone through again.
    state.set_commands_left(most_commands);
    for (const Action action : beginning.actions)
      if (model_.act(state, action, next)) state = next.state;
    state.set_commands_left(model_.question().commands);
    state.set_faults_left(model_.question().fault_budget);
    text += trimmed(states(state) + "at the beginning: " + beginning.name);
    for (std::size_t i = 0; i < trace.actions.size(); ++i) {
      if (trace.cycle != 0 && i + trace.cycle == trace.actions.size()) text += trimmed(lifelines(state) + "from here on again and again:");
      text += trimmed(line(state, i + 1, trace.actions[i]) + sentence(state, trace.actions[i]));
      try {
        model_.act(state, trace.actions[i], next);
      } catch (const sim::InvariantBroken& broken) {
        return text + trimmed(lifelines(state) + "breaks " + broken.what());
      }
      if (states(next.state) != states(state)) text += trimmed(states(next.state));
      for (std::size_t p = 0; p < property_count; ++p) {
        const auto property = static_cast<Property>(p);
        if (must_always_hold(property) && next.properties.contains(property)) text += trimmed(lifelines(next.state) + "violates " + std::string(name_of(property)));
      }
      state = next.state;
    }
    return text;
  }

 private:
  std::string lifelines(const State& state) const {
    std::string text(margin + column * tree_.participants(), ' ');
    for (std::size_t p = 0; p < tree_.participants(); ++p) text[margin + column * p] = model_.is_down(state, p) ? ' ' : '|';
    return text;
  }
  std::string states(const State& state) const {
    std::string text(margin, ' ');
    for (std::size_t p = 0; p < tree_.participants(); ++p)
      text += padded(model_.is_down(state, p) ? "down" : std::string(handshake::name_of(model_.state_of(state, p))), column);
    return text;
  }
  /// An arrow for what is heard, a mark for everything else.
  std::string line(const State& state, std::size_t step, Action action) const {
    std::string text = lifelines(state);
    const std::string digits = std::to_string(step);
    text.replace(0, margin, padded(std::string(margin - 2 - std::min(digits.size(), margin - 2), ' ') + digits, margin));
    if (action.kind == ActionKind::receive) {
      const std::size_t from = margin + column * tree_.channel(action.who).sender;
      const std::size_t to = margin + column * tree_.channel(action.who).receiver;
      for (std::size_t i = std::min(from, to) + 1; i < std::max(from, to); ++i)
        if (text[i] == ' ') text[i] = '-';
      (from < to ? text[to - 1] : text[to + 1]) = from < to ? '>' : '<';
      return text;
    }
    const bool of_channel = action.kind == ActionKind::send || action.kind == ActionKind::lose;
    const bool of_node = action.kind == ActionKind::crash || action.kind == ActionKind::restart;
    const char mark = action.kind == ActionKind::send ? 'o' : action.kind == ActionKind::crash ? 'X' : '*';
    for (std::size_t p = 0; p < tree_.participants(); ++p)
      if (of_channel ? tree_.channel(action.who).sender == p : of_node ? tree_.node_of(p) == action.who : action.who == p) text[margin + column * p] = mark;
    return text;
  }
  std::string word(const handshake::Word& word, std::size_t sender) const {
    const std::size_t origin = tree_.number_of(tree_.group_of(sender), word.intent.origin);
    return std::string(handshake::name_of(word.state)) + " (intent " + std::to_string(word.intent.number) + " " + std::string(handshake::name_of(word.intent.kind)) +
           " of " + tree_.name(origin) + ", run " + std::to_string(word.run & 0xFFFFU) + ")";
  }
  std::string sentence(const State& state, Action action) const {
    const bool of_channel = action.kind == ActionKind::send || action.kind == ActionKind::receive || action.kind == ActionKind::lose;
    if (of_channel) {
      const TreeShape::Channel& ends = tree_.channel(action.who);
      const std::string from = tree_.name(ends.sender);
      const std::string to = tree_.name(ends.receiver);
      if (action.kind == ActionKind::send) return from + " publishes to " + to + ": " + word(model_.word(state, ends.sender), ends.sender);
      const std::string text = word(model_.word_in(state, action.who), ends.sender);
      return action.kind == ActionKind::receive ? to + " hears " + from + ": " + text : "fault: lost between " + from + " and " + to + ": " + text;
    }
    if (action.kind == ActionKind::crash) return "fault: " + tree_.node_name(action.who) + " crashes";
    if (action.kind == ActionKind::restart) {
      const bool was_down = model_.is_down(state, tree_.participant_of(action.who, handshake::Side::Outer));
      return was_down ? tree_.node_name(action.who) + " comes up" : "fault: " + tree_.node_name(action.who) + " restarts without memory";
    }
    const std::string who = tree_.name(action.who);
    switch (action.kind) {
      case ActionKind::initialised: return who + " has initialised";
      case ActionKind::silence: return who + " notices that " + tree_.name(tree_.peer_of(action.who, action.what)) + " is silent";
      case ActionKind::call: return std::string(program::methods[action.what].name) + " is called at the " + who;
      case ActionKind::finish: return "the Program of " + who + " ends by itself";
      case ActionKind::forge: {
        const Letter letter = forgeries(model_.word(state, action.who), tree_.size(tree_.group_of(action.who)) - 1)[action.what];
        return "fault: a stranger speaks as " + who + ": " + word(letter.word, action.who) + (letter.ahead ? ", far ahead" : "");
      }
      case ActionKind::timeout: return "fault: " + who + " hears nothing of " + tree_.name(tree_.peer_of(action.who, action.what)) + " in time";
      default: return {};
    }
  }

  TreeModel model_;
  const TreeShape& tree_;
};

}  // namespace

std::string tree_chart(const Question& question, const Beginning& beginning, const Trace& trace) { return Drawing(question).draw(beginning, trace); }

}  // namespace takt::explore
