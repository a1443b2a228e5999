// SPDX-License-Identifier: Apache-2.0
#include "report/sequence_figure.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>

namespace takt::report {
namespace {

std::string microseconds(std::int64_t ps) { return fmt::format("{:.1f} us", static_cast<double>(ps) * 1e-6); }

/// The state of a participant at an instant, what happens at it included.
handshake::PublishedState state_at(const scenario::ProgramMonitor& monitor, std::size_t participant,
                                   sim::TrueTime time) {
  handshake::PublishedState state = handshake::PublishedState::Halted;
  for (const scenario::StateRecord& record : monitor.history())
    if (record.participant == participant && record.time <= time) state = record.change.to;
  return state;
}

std::string text_of(handshake::PublishedState state) { return std::string(handshake::name_of(state)); }

/// The message by which each other participant hears of a change: the first that was sent after it.
std::vector<const LoggedMessage*> notifications(const MessageLog& log, const scenario::StateRecord& change) {
  std::map<std::size_t, const LoggedMessage*> first;
  for (const LoggedMessage& message : log.messages())
    if (message.is_state && message.from == change.participant && message.sent >= change.time)
      first.emplace(message.to, &message);
  std::vector<const LoggedMessage*> all;
  for (const auto& [to, message] : first) all.push_back(message);
  return all;
}

}  // namespace

chart::SequenceChart sequence_of(const scenario::Run& run, const MessageLog& log, const Excerpt& excerpt) {
  const scenario::ProgramMonitor& monitor = run.monitor(excerpt.program);
  const scenario::ResolvedProgram& program = run.resolved().programs[excerpt.program];
  chart::SequenceChart drawn;
  drawn.title = excerpt.title;
  const std::int64_t zero = excerpt.from.ps();
  drawn.label = [zero](std::int64_t time) { return "+" + microseconds(time - zero); };
  for (std::size_t p = 0; p < program.members.size(); ++p) {
    drawn.participants.push_back(run.resolved().topology.nodes[program.members[p].node.value].name);
    drawn.states.push_back(text_of(state_at(monitor, p, excerpt.from - sim::Duration::from_ps(1))));
  }
  std::string before = excerpt.call.empty() ? std::string() : excerpt.call + ": ";  // stands with what it causes
  const bool is_start = excerpt.numbers == Numbers::start;
  int number = 0;
  std::set<const LoggedMessage*> shown;
  sim::TrueTime end = excerpt.from;
  for (const scenario::StateRecord& record : monitor.history()) {
    if (record.time < excerpt.from || record.time > excerpt.to) continue;
    // INIT stands before the numbers of Fig. 3.
    const bool is_numbered = excerpt.numbers != Numbers::none && record.change.transition != 0;
    const auto numbered = [&](const std::string& text) {
      if (!is_numbered || (!is_start && number >= 3)) return text;
      ++number;
      return is_start ? fmt::format("({}) {}", number, text)
                      : fmt::format("({}{}) {}", number, excerpt.numbers == Numbers::side_a ? 'a' : 'b', text);
    };
    drawn.steps.push_back({record.time.ps(), record.participant, before + numbered(text_of(record.change.to))});
    before.clear();
    for (const LoggedMessage* message : notifications(log, record)) {
      if (!shown.insert(message).second) continue;
      const std::string text = text_of(state_at(monitor, message->from, message->sent));
      const bool is_answer = is_start ? number >= 7 : number >= 3;
      drawn.messages.push_back(
          {message->sent.ps(), message->received.ps(), message->from, message->to, is_answer ? text : numbered(text)});
      end = std::max(end, message->received);
    }
  }
  if (is_start)
    for (std::size_t from = 0; from < program.members.size(); ++from) {
      const auto first = std::find_if(log.messages().begin(), log.messages().end(), [&](const LoggedMessage& m) {
        return !m.is_state && m.from == from && m.sent > end;
      });
      if (first != log.messages().end())
        drawn.messages.push_back({first->sent.ps(), first->received.ps(), first->from, first->to, "(8) process data"});
    }
  return drawn;
}

}  // namespace takt::report
