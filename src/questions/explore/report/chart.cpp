// SPDX-License-Identifier: Apache-2.0
#include "explore/report/chart.hpp"

#include <algorithm>

namespace takt::explore {

std::string padded(std::string text, std::size_t width) {
  if (text.size() < width) text.resize(width, ' ');
  return text;
}

namespace {

constexpr std::size_t margin = 6;

std::string trimmed(std::string line) {
  line.erase(line.find_last_not_of(' ') + 1);
  return line + "\n";
}
std::string number(std::size_t value) {
  const std::string digits = std::to_string(value);
  return std::string(digits.size() < margin - 2 ? margin - 2 - digits.size() : 0, ' ') + digits + "  ";
}

class Drawing {
 public:
  explicit Drawing(const Chart& chart) : chart_(chart) {}

  std::string text() const {
    std::string text = trimmed(columns(chart_.names));
    const std::vector<std::string>* before = &chart_.states;
    text += trimmed(columns(*before) + "at the beginning: " + chart_.beginning);
    for (const std::string& note : chart_.notes) text += trimmed(lifelines(*before) + note);
    for (std::size_t i = 0; i < chart_.steps.size(); ++i) {
      const ChartStep& step = chart_.steps[i];
      if (chart_.cycle != 0 && i + chart_.cycle == chart_.steps.size())
        text += trimmed(lifelines(*before) + "from here on again and again:");
      text += trimmed(line(step, i + 1) + step.sentence);
      if (step.states != *before) text += trimmed(columns(step.states));
      for (const std::string& note : step.notes) text += trimmed(lifelines(step.states) + note);
      for (const std::string& finding : step.findings) text += trimmed(lifelines(step.states) + finding);
      before = &step.states;
    }
    return text;
  }

 private:
  std::string columns(const std::vector<std::string>& cells) const {
    std::string line(margin, ' ');
    for (const std::string& cell : cells) line += padded(cell, chart_.width);
    return line;
  }
  std::size_t place(std::size_t column) const { return margin + chart_.width * column; }
  std::string lifelines(const std::vector<std::string>& states) const {
    std::string line(place(states.size()), ' ');
    for (std::size_t i = 0; i < states.size(); ++i) line[place(i)] = states[i] == down_state ? ' ' : '|';
    return line;
  }
  std::string line(const ChartStep& step, std::size_t count) const {
    std::string line = lifelines(step.states);
    line.replace(0, margin, number(count));
    for (const std::size_t column : step.marked) line[place(column)] = step.mark;
    if (!step.arrow) return line;
    const std::size_t from = place(step.arrow->first);
    const std::size_t to = place(step.arrow->second);
    for (std::size_t i = std::min(from, to) + 1; i < std::max(from, to); ++i)
      if (line[i] == ' ') line[i] = '-';
    (from < to ? line[to - 1] : line[to + 1]) = from < to ? '>' : '<';
    return line;
  }

  const Chart& chart_;
};

std::vector<std::string> states_of(const ReplayStep& done) {
  std::vector<std::string> states;
  for (std::size_t i = 0; i < done.states.size(); ++i)
    states.push_back(done.down[i] ? down_state : std::string(handshake::name_of(done.states[i])));
  return states;
}

}  // namespace

std::string drawn(const Chart& chart) { return Drawing(chart).text(); }

std::string participant_name(std::size_t participant) {
  return participant == 0 ? "master" : "slave " + std::to_string(participant);
}

std::string text_of(const handshake::Word& word, const std::string& origin) {
  const std::string state(handshake::name_of(word.state));
  if (word.incarnation == 0) return state;  // `paper` says no more
  return state + " (intent " + std::to_string(word.intent.number) + " " +
         std::string(handshake::name_of(word.intent.kind)) + " of " + origin + ", run " +
         std::to_string(word.run & 0xFFFFU) + ")";
}

std::string sentence(const Happening& it) {
  switch (it.kind) {
    case ActionKind::send:
      return it.from + " publishes to " + it.to + ": " + it.word;
    case ActionKind::receive:
      return it.to + " hears " + it.from + ": " + it.word;
    case ActionKind::deliver_late:
      return it.to + " hears a late word of " + it.from + ": " + it.word;
    case ActionKind::initialised:
      return it.who + " has initialised";
    case ActionKind::silence:
      return it.who + " notices that " + it.peer + " is silent";
    case ActionKind::call:
      return std::string(program::methods[it.method].name) + " is called at the " + it.who;
    case ActionKind::finish:
      return "the Program of " + it.who + " ends by itself";
    case ActionKind::join:
      return it.who + " joins";
    case ActionKind::leave:
      return it.who + " asks to be let go";
    case ActionKind::change_key:
      return "the key of " + it.who + " changes";
    case ActionKind::lose:
      return "fault: lost between " + it.from + " and " + it.to + ": " + it.word;
    case ActionKind::duplicate:
      return "fault: duplicated between " + it.from + " and " + it.to;
    case ActionKind::reorder:
      return "fault: " + std::string(it.is_overtaking ? "overtaken" : "delayed") + " between " + it.from + " and " +
             it.to + (it.is_overtaking ? " by " : ": ") + it.word;
    case ActionKind::crash:
      return "fault: " + it.who + " crashes";
    case ActionKind::restart:
      return it.comes_up ? it.who + " comes up" : "fault: " + it.who + " restarts without memory";
    case ActionKind::forge:
      return "fault: a stranger speaks as " + it.who + ": " + it.word + (it.is_overtaking ? ", far ahead" : "");
    case ActionKind::replay:
      return "fault: a stranger replays to " + it.to + " a word of " + it.from + ": " + it.word;
    case ActionKind::timeout:
      return "fault: " + it.who + " hears nothing of " + it.peer + " in time";
  }
  return {};
}

std::string sentence(const ReplayStep& done, const Wiring& wiring) {
  return sentence({done.action.kind, participant_name(done.action.who), participant_name(wiring.sender(done.channel)),
                   participant_name(wiring.receiver(done.channel)),
                   participant_name(peer_participant(done.action.who, done.action.what)),
                   text_of(done.word, participant_name(done.word.intent.origin)), done.action.what, done.is_overtaking,
                   false});
}

Chart chart_of_group(const Query& query, const Replay& replayed) {
  const Wiring wiring(query);
  Chart chart;
  for (std::size_t i = 0; i <= query.slaves; ++i) chart.names.push_back(participant_name(i));
  chart.origins.assign(chart.names.size(), chart.names);
  chart.moment = replayed.moment;
  chart.beginning = replayed.beginning;
  chart.states.assign(chart.names.size(), std::string(handshake::name_of(handshake::PublishedState::Halted)));
  if (!replayed.opening_steps.empty()) chart.states = states_of(replayed.opening_steps.back());
  chart.cycle = replayed.cycle;
  for (const ReplayStep& done : replayed.steps) {
    ChartStep& step = chart.steps.emplace_back();
    step.sentence = sentence(done, wiring);
    step.states = states_of(done);
    step.action = done.action;
    step.actor = done.actor;
    step.moment = done.moment;
    const bool heard = done.action.kind == ActionKind::receive || done.action.kind == ActionKind::deliver_late ||
                       done.action.kind == ActionKind::replay;
    if (heard)
      step.arrow = {wiring.sender(done.channel), wiring.receiver(done.channel)};
    else
      step.marked = {done.actor};
    step.mark = mark_of(done.action.kind);
    for (const handshake::Violation& violation : done.violations)
      step.findings.push_back("violates " + std::string(handshake::name_of(violation.invariant)) + ": " +
                              participant_name(violation.participant) + " " +
                              std::string(handshake::text_of(violation.finding)));
    if (!done.broken.empty()) step.findings.push_back("breaks " + done.broken);
  }
  return chart;
}

Chart chart_of(const Query& query, const Beginning& beginning, const Trace& trace) {
  if (query.has_roles()) return chart_of_roles(query, beginning, trace);
  return query.is_tree() ? chart_of_tree(query, beginning, trace)
                         : chart_of_group(query, replay(query, beginning, trace));
}

std::string chart(const Query& query, const Replay& replayed) { return drawn(chart_of_group(query, replayed)); }
std::string chart(const Query& query, const Beginning& beginning, const Trace& trace) {
  return drawn(chart_of(query, beginning, trace));
}

}  // namespace takt::explore
