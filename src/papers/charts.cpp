#include "papers/charts.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>

#include "chart/bar_chart.hpp"
#include "chart/sequence_chart.hpp"
#include "chart/state_chart.hpp"
#include "program/table.hpp"

namespace takt::papers {
namespace {

std::string microseconds(std::int64_t ps) { return fmt::format("{:.1f} us", static_cast<double>(ps) * 1e-6); }

/// The state of a participant at an instant, what happens at it included.
handshake::PublishedState state_at(const scenario::ProgramMonitor& monitor, std::size_t participant, sim::TrueTime time) {
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
    if (message.is_state && message.from == change.participant && message.sent >= change.time) first.emplace(message.to, &message);
  std::vector<const LoggedMessage*> all;
  for (const auto& [to, message] : first) all.push_back(message);
  return all;
}

}  // namespace

std::string state_machine_chart() {
  using program::State;
  std::vector<chart::StateBox> boxes = {{"Halted", 120, 90}, {"Ready", 480, 90}, {"Running", 480, 330}, {"Suspended", 120, 330}};
  const auto box_of = [](State state) -> std::size_t {
    switch (state) {
      case State::Halted: return 0;
      case State::Ready: return 1;
      case State::Running: return 2;
      case State::Suspended: return 3;
    }
    return 0;
  };
  std::vector<chart::TransitionArc> arcs;
  for (const program::Transition& transition : program::transitions) {
    std::string methods;
    for (const program::Method method : {program::Method::Start, program::Method::Suspend, program::Method::Resume, program::Method::Halt, program::Method::Reset})
      if (transition.causes.contains(method)) methods += " " + std::string(program::name_of(method));
    arcs.push_back({box_of(transition.from), box_of(transition.to), fmt::format("{}{}", transition.number, methods), methods.empty()});
  }
  return chart::state_chart("Fig. 1: OPC UA Program, four states and nine transitions", boxes, arcs, 620, 420);
}

std::string sequence_of(const scenario::Run& run, const MessageLog& log, const Excerpt& excerpt) {
  const scenario::ProgramMonitor& monitor = run.monitor(0);
  const scenario::ResolvedProgram& program = run.resolved().programs[0];
  chart::SequenceChart drawn;
  drawn.title = excerpt.title;
  const std::int64_t zero = excerpt.from.ps();
  drawn.label = [zero](std::int64_t time) { return "+" + microseconds(time - zero); };
  for (std::size_t p = 0; p < program.members.size(); ++p) {
    drawn.participants.push_back(run.resolved().topology.nodes[program.members[p].node.value].name);
    drawn.states.push_back(text_of(state_at(monitor, p, excerpt.from - sim::Duration::from_ps(1))));
  }
  std::string before = excerpt.call + ": ";   // stands with what it causes
  int number = 0;
  std::set<const LoggedMessage*> shown;
  sim::TrueTime end = excerpt.from;
  for (const scenario::StateRecord& record : monitor.history()) {
    if (record.time < excerpt.from || record.time > excerpt.to) continue;
    // INIT stands before the numbers of Fig. 3.
    const bool is_numbered = record.change.transition != 0;
    const auto numbered = [&](const std::string& text) {
      if (!is_numbered || (excerpt.side != 0 && number >= 3)) return text;
      ++number;
      return excerpt.side == 0 ? fmt::format("({}) {}", number, text) : fmt::format("({}{}) {}", number, excerpt.side, text);
    };
    drawn.steps.push_back({record.time.ps(), record.participant, before + numbered(text_of(record.change.to))});
    before.clear();
    for (const LoggedMessage* message : notifications(log, record)) {
      if (!shown.insert(message).second) continue;
      const std::string text = text_of(state_at(monitor, message->from, message->sent));
      const bool is_answer = excerpt.side == 0 ? number >= 7 : number >= 3;
      drawn.messages.push_back({message->sent.ps(), message->received.ps(), message->from, message->to, is_answer ? text : numbered(text)});
      end = std::max(end, message->received);
    }
  }
  if (excerpt.side == 0)
    for (std::size_t from = 0; from < program.members.size(); ++from) {
      const auto first = std::find_if(log.messages().begin(), log.messages().end(),
                                      [&](const LoggedMessage& m) { return !m.is_state && m.from == from && m.sent > end; });
      if (first != log.messages().end()) drawn.messages.push_back({first->sent.ps(), first->received.ps(), first->from, first->to, "(8) process data"});
    }
  return chart::sequence_chart(drawn);
}

std::string reactions_chart(const BeyondTable& table) {
  std::vector<chart::BarGroup> groups;
  for (const BeyondRow& row : table.rows) {
    chart::BarGroup group;
    group.name = row.variant;
    for (const ReactionCell& cell : row.reactions)
      group.bars.push_back({cell.simulated ? static_cast<double>(cell.simulated->ps()) * 1e-9 : 0, cell.bound ? std::optional(static_cast<double>(cell.bound->ps()) * 1e-9) : std::nullopt});
    groups.push_back(std::move(group));
  }
  return chart::bar_chart(table.question, "reaction time (ms): bar simulated maximum, line analytic bound", {reaction_names.begin(), reaction_names.end()}, groups);
}

}  // namespace takt::papers
