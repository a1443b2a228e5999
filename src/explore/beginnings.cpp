// The states in which runs begin: every state in which a group can rest, each reached by calls at the master over a
// prompt network.
#include <span>
#include <utility>

#include "explore/model.hpp"

namespace takt::explore {

using handshake::PublishedState;
using program::Method;

namespace {

struct Rest {
  const char* name;
  PublishedState state;
  std::vector<Method> calls;
};

}  // namespace

void Model::make_beginnings() {
  const std::vector<Rest> rests{{"switched on", PublishedState::Halted, {}},
                                {"Running", PublishedState::Running, {Method::Start}},
                                {"Suspended", PublishedState::Suspended, {Method::Start, Method::Suspend}},
                                {"Ready after a reset", PublishedState::Ready, {Method::Start, Method::Suspend, Method::Reset}}};
  const std::size_t wanted = question_.beginnings == Beginnings::all ? rests.size() : 1;
  for (const Rest& rest : std::span(rests).first(wanted)) {
    Beginning beginning{rest.name, {}, switched_on()};
    beginning.state.set_commands_left(most_commands);
    for (const Method method : rest.calls) {
      take(beginning, {ActionKind::call, 0, static_cast<std::uint8_t>(program::index_of(method))});
      settle(beginning);
    }
    bool reached = true;
    for (std::size_t i = 0; i <= question_.slaves; ++i) reached = reached && members_[beginning.state.member(i)].state == rest.state;
    if (!reached) continue;  // a handshake that does not get there fails elsewhere
    beginning.state.set_commands_left(question_.commands);
    beginning.state.set_faults_left(question_.fault_budget);
    beginnings_.push_back(std::move(beginning));
  }
}

State Model::switched_on() {
  State state(shape_);
  for (std::size_t i = 0; i <= question_.slaves; ++i) state.set_member(i, members_.fresh(i, 1));
  state.set_ghost(intern_ghost(Ghost(question_.variant, question_.slaves + 1U)));
  return state;
}

void Model::take(Beginning& beginning, Action action) {
  Next next;
  if (!act(beginning.state, action, next)) return;
  beginning.state = next.state;
  beginning.actions.push_back(action);
}

/// Everybody initialises, publishes and hears in turn.
void Model::settle(Beginning& beginning) {
  for (int round = 0; round < 6; ++round) {
    for (std::uint8_t i = 0; i <= question_.slaves; ++i) take(beginning, {ActionKind::initialised, i, 0});
    for (std::uint8_t c = 0; c < wiring_.size(); ++c) {
      take(beginning, {ActionKind::send, c, 0});
      take(beginning, {ActionKind::receive, c, 0});
    }
  }
}

}  // namespace takt::explore
