// SPDX-License-Identifier: Apache-2.0
// A found run once more, with the very participants, the very observer and real sequence numbers: what happens in each
// step, for people and for scenario files. It shares no code with the search but the names of the actions.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "explore/model/action.hpp"
#include "explore/model/model.hpp"
#include "explore/report/moment.hpp"
#include "explore/search/search.hpp"
#include "handshake/observer.hpp"

namespace takt::explore {

/// One step of the run.
struct ReplayStep {
  Action action;
  std::vector<handshake::PublishedState> states;  ///< of all, after it
  std::vector<bool> down;
  std::size_t actor = 0;    ///< who steps, or whose message it is
  std::size_t channel = 0;  ///< on which it was published or heard
  handshake::Word word;     ///< published or heard
  bool has_word = false;
  bool is_overtaking = false;                    ///< the word overtakes another one at once
  std::vector<handshake::Violation> violations;  ///< found in this step
  Moment moment;                                 ///< after it; where a CHECK was broken, before it
  std::string broken;                            ///< the CHECK that it breaks; then nothing follows
};

struct Replay {
  std::string beginning;
  std::vector<ReplayStep> opening_steps;  ///< calls and messages that lead to the beginning
  Moment moment;                          ///< at the beginning
  std::vector<ReplayStep> steps;
  std::size_t cycle = 0;  ///< of Trace
};

/// Plays the trace from switched on.
Replay replay(const Query& query, const Beginning& beginning, const Trace& trace);

/// The invariant that the observer reports for a property; false for L1, F1 and whatever must be reached.
bool observed(const Replay& replayed, Property property);

}  // namespace takt::explore
