// SPDX-License-Identifier: Apache-2.0
// A scheduled scenario gets another schedule while it runs: the plant afterwards, the way there, and what the simulator
// says of it.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "synthesis/scenario_changes.hpp"
#include "synthesis/scenario_schedule.hpp"
#include "synthesis/transition_judge.hpp"

namespace takt::synthesis {

inline constexpr sim::Duration usual_lead = sim::Duration::from_ps(10'000'000'000);

struct ScenarioChange {
  bool is_done = false;  ///< all that was asked for has a place, and there is a transition
  std::string how;       ///< if not: what stood in the way
  std::vector<StreamChange> changes;
  std::vector<std::string> without_place;     ///< that should come, and do not
  std::vector<std::string> without_way;       ///< streams without windows over what has failed
  std::vector<std::string> would_pause;       ///< streams for which no order of steps keeps them running
  sim::Duration at;                           ///< when it begins, and fails what fails
  std::unique_ptr<scenario::Resolved> after;  ///< the plant afterwards, scheduled; null: there is no transition
  scenario::Scenario plant;                   ///< the same with automatic gates
  ChangedFlows flows;
  Transition transition;
  TransitionScenario simulated;
  TransitionVerdict verdict;
  std::vector<std::string> wrong;  ///< what a judge found; takt is wrong then
};

/// Mistakes go to `diagnostics`; then the answer is nothing. `plant`: what the running schedule was made of, if that is
/// known (see place_changes()).
std::optional<ScenarioChange> change_scenario(const scenario::Scenario& running,
                                              const std::optional<scenario::Scenario>& plant, const AskedChanges& asked,
                                              json::Diagnostics& diagnostics);

/// What a file of streams that come says: {"streams": [...], "require": [...]}, as in a scenario.
struct ComingStreams {
  std::vector<scenario::Stream> streams;
  std::vector<scenario::Requirement> require;
};
const json::Object& describe(json::Type<ComingStreams>);

}  // namespace takt::synthesis
