// SPDX-License-Identifier: Apache-2.0
// A transition as a scenario: it begins with the old lists and streams, and its script brings the new ones.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "scenario/description/description.hpp"
#include "synthesis/scenario_changes.hpp"
#include "synthesis/transition.hpp"

namespace takt::synthesis {

/// What a stream of the transition's scenario does if nothing goes wrong.
struct ExpectedStream {
  std::string name;         ///< there
  FlowIndex flow = 0;       ///< in TransitionProblem::flows.streams
  bool of_program = false;  ///< when it sends is not the schedule's matter, only that it keeps its windows
  Duration offset;          ///< when the first frame is due; of a program 0
  Duration lag;             ///< from then to its release
  Duration period;
  std::optional<Duration> until;  ///< no frame is due from then on
  Duration latency;               ///< from the release
  Duration
      early;  ///< a frame may be produced so much later than it is due, or need so much less until it is at its port
  Duration least_receive, greatest_receive;  ///< what the operating systems of its listeners add
  bool waits_at_listener = false;            ///< a processor of a listener takes its frames in, whenever it can
  bool has_one_listener = true;
  std::uint64_t may_lose = 0;       ///< frames that what fails takes
  bool ends_with_its_host = false;  ///< it sends no more when its host has failed
};

/// A port at the end.
struct ExpectedPort {
  models::NodeIndex node;
  std::uint16_t port = 0;
  std::string name;
  Duration base_time;  ///< of the list that was written last
  scenario::GateList list;
};

struct TransitionScenario {
  scenario::Scenario scenario;
  std::vector<ExpectedStream> streams;
  std::vector<ExpectedPort> ports;  ///< to which lists are written
  Duration margin;                  ///< of the windows: a latency may be that much longer or shorter
};

/// What changed for the flows of a problem.
struct ChangedFlows {
  TransitionProblem problem;
  std::vector<std::string> names;  ///< by flow: of its stream
  std::vector<Duration> lags;      ///< by flow: from due to released
  std::vector<bool> of_program;    ///< by flow
};

/// `at`: when what fails does so. The streams of `changes` stand in its order in changed.problem.changes.
TransitionScenario make_transition_scenario(const scenario::Scenario& running, const scenario::Resolved& resolved,
                                            const PlacedChanges& placed, const ChangedFlows& changed,
                                            const Transition& transition, Duration at);

}  // namespace takt::synthesis
