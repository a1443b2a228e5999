// SPDX-License-Identifier: Apache-2.0
// The states in which runs begin: every state in which a group can rest, each reached by calls at the master over a
// prompt network.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "explore/model/model.hpp"
#include "handshake/participant.hpp"

namespace takt::explore {

struct Rest {
  const char* name;
  handshake::PublishedState state;
  std::vector<program::Method> calls;
};

/// Switched on comes first.
inline const std::vector<Rest>& rests() {
  using handshake::PublishedState;
  using program::Method;
  static const std::vector<Rest> all{
      {"switched on", PublishedState::Halted, {}},
      {"Running", PublishedState::Running, {Method::Start}},
      {"Suspended", PublishedState::Suspended, {Method::Start, Method::Suspend}},
      {"Ready after a reset", PublishedState::Ready, {Method::Start, Method::Suspend, Method::Reset}}};
  return all;
}

/// Goes from one state to the next.
template <class M>
class Opening {
 public:
  Opening(M& model, const State& switched_on, std::string name)
      : model_(model), beginning_{std::move(name), {}, switched_on} {
    beginning_.state.set_commands_left(most_commands);
  }
  void take(Action action) {
    Next next;
    if (!model_.act(beginning_.state, action, next)) return;
    beginning_.state = next.state;
    beginning_.actions.push_back(action);
  }
  void call(program::Method method) {
    take({ActionKind::call, 0, static_cast<std::uint8_t>(program::index_of(method))});
  }
  /// Everybody initialises, publishes and hears in turn.
  void settle(std::size_t participants, std::size_t channels, int rounds) {
    for (int round = 0; round < rounds; ++round) {
      for (std::uint8_t p = 0; p < participants; ++p) take({ActionKind::initialised, p, 0});
      for (std::uint8_t c = 0; c < channels; ++c) {
        take({ActionKind::send, c, 0});
        take({ActionKind::receive, c, 0});
      }
    }
  }
  /// Keeps it, with the budgets of the query, if all are in that state; a handshake that does not get there fails
  /// elsewhere.
  void keep(std::size_t participants, handshake::PublishedState rest, std::vector<Beginning>& beginnings) {
    for (std::size_t p = 0; p < participants; ++p)
      if (model_.state_of(beginning_.state, p) != rest) return;
    beginning_.state.set_commands_left(model_.query().commands);
    beginning_.state.set_faults_left(model_.query().fault_budget);
    beginnings.push_back(std::move(beginning_));
  }

 private:
  M& model_;
  Beginning beginning_;
};

}  // namespace takt::explore
