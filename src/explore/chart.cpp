#include "explore/chart.hpp"

#include <algorithm>

namespace takt::explore {
namespace {

constexpr std::size_t margin = 6;
constexpr std::size_t column = 13;

std::string padded(std::string text, std::size_t width) {
  if (text.size() < width) text.resize(width, ' ');
  return text;
}
std::string number(std::size_t value) {
  const std::string digits = std::to_string(value);
  return std::string(digits.size() < margin - 2 ? margin - 2 - digits.size() : 0, ' ') + digits + "  ";
}
std::string text_of(const handshake::Word& word) {
  std::string text(handshake::name_of(word.state));
  if (word.incarnation == 0) return text;  // `paper` says no more
  text += " (intent " + std::to_string(word.intent.number) + " " + std::string(handshake::name_of(word.intent.kind)) + " of " +
          participant_name(word.intent.origin) + ", run " + std::to_string(word.run & 0xFFFFU) + ")";
  return text;
}

std::string lifelines(const Told& told) {
  std::string line(margin + column * told.states.size(), ' ');
  for (std::size_t i = 0; i < told.states.size(); ++i) line[margin + column * i] = told.down[i] ? ' ' : '|';
  return line;
}

/// The drawing of a step: an arrow for what is heard, a mark for everything else.
std::string drawing(const Told& told, const Wiring& wiring, std::size_t step) {
  std::string line = lifelines(told);
  line.replace(0, margin, number(step));
  const ActionKind kind = told.action.kind;
  const bool heard = kind == ActionKind::receive || kind == ActionKind::deliver_late;
  if (!heard) {
    line[margin + column * told.actor] = kind == ActionKind::send ? 'o' : kind == ActionKind::crash ? 'X' : '*';
    return line;
  }
  const std::size_t from = margin + column * wiring.sender(told.channel);
  const std::size_t to = margin + column * wiring.receiver(told.channel);
  for (std::size_t i = std::min(from, to) + 1; i < std::max(from, to); ++i)
    if (line[i] == ' ') line[i] = '-';
  (from < to ? line[to - 1] : line[to + 1]) = from < to ? '>' : '<';
  return line;
}

std::string states(const Told& told) {
  std::string line(margin, ' ');
  for (std::size_t i = 0; i < told.states.size(); ++i)
    line += padded(told.down[i] ? "down" : std::string(handshake::name_of(told.states[i])), column);
  return line;
}

std::string trimmed(std::string line) {
  line.erase(line.find_last_not_of(' ') + 1);
  return line + "\n";
}

}  // namespace

std::string participant_name(std::size_t participant) { return participant == 0 ? "master" : "slave " + std::to_string(participant); }

std::string sentence(const Told& told, const Wiring& wiring) {
  const std::string who = participant_name(told.action.who);
  const std::string actor = participant_name(told.actor);
  const std::string from = participant_name(wiring.sender(told.channel));
  const std::string to = participant_name(wiring.receiver(told.channel));
  const std::string peer = participant_name(peer_participant(told.action.who, told.action.what));
  switch (told.action.kind) {
    case ActionKind::send: return actor + " publishes to " + to + ": " + text_of(told.word);
    case ActionKind::receive: return to + " hears " + from + ": " + text_of(told.word);
    case ActionKind::deliver_late: return to + " hears a late word of " + from + ": " + text_of(told.word);
    case ActionKind::initialised: return who + " has initialised";
    case ActionKind::silence: return who + " notices that " + peer + " is silent";
    case ActionKind::call: return std::string(program::methods[told.action.what].name) + " is called at the " + who;
    case ActionKind::finish: return "the Program of " + who + " ends by itself";
    case ActionKind::lose: return "fault: lost between " + from + " and " + to + ": " + text_of(told.word);
    case ActionKind::duplicate: return "fault: duplicated between " + from + " and " + to;
    case ActionKind::reorder:
      return told.is_overtaking ? "fault: overtaken between " + from + " and " + to + " by " + text_of(told.word)
                                : "fault: delayed between " + from + " and " + to + ": " + text_of(told.word);
    case ActionKind::crash: return "fault: " + who + " crashes";
    case ActionKind::restart: return "fault: " + who + " restarts without memory";
    case ActionKind::forge: return "fault: a stranger speaks as " + who + ": " + text_of(told.word) + (told.is_overtaking ? ", far ahead" : "");
    case ActionKind::timeout: return "fault: " + who + " hears nothing of " + peer + " in time";
  }
  return {};
}

std::string chart(const Question& question, const Story& story) {
  const std::size_t participants = question.slaves + 1U;
  const Wiring wiring(question);
  std::string text(margin, ' ');
  for (std::size_t i = 0; i < participants; ++i) text += padded(participant_name(i), column);
  text = trimmed(text);
  Told before;
  before.states.assign(participants, handshake::PublishedState::Halted);
  before.down.assign(participants, false);
  if (!story.opening_steps.empty()) before = story.opening_steps.back();
  text += trimmed(states(before) + "at the beginning: " + story.beginning);
  std::size_t step = 0;
  for (const Told& told : story.steps) {
    if (story.cycle != 0 && step + story.cycle == story.steps.size()) text += trimmed(lifelines(before) + "from here on again and again:");
    text += trimmed(drawing(told, wiring, ++step) + sentence(told, wiring));
    if (told.states != before.states || told.down != before.down) text += trimmed(states(told));
    for (const handshake::Violation& violation : told.violations)
      text += trimmed(lifelines(told) + "violates " + std::string(handshake::name_of(violation.invariant)) + ": " +
                      participant_name(violation.participant) + " " + std::string(handshake::text_of(violation.finding)));
    before = told;
  }
  return text;
}

}  // namespace takt::explore
