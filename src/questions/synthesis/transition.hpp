// SPDX-License-Identifier: Apache-2.0
// From the gate lists that run to those of the next schedule, in steps of which none takes its windows from a stream
// that runs.
//
// Make before break: ports first get lists with the windows of what is and of what comes; when all of these hold,
// talkers change over; when the last frame at an old time is surely out, lists without its windows follow. What comes
// may need room that only a stream makes which has to change over first: then there are several rounds.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "scenario/resolved/gate_problem.hpp"

namespace takt::synthesis {

using sim::Duration;
using FlowIndex = std::uint32_t;

/// A stream that comes, goes, or does both: it moves to other times or ports.
struct FlowChange {
  std::optional<FlowIndex> leaves;  ///< in TransitionProblem::flows.streams
  std::optional<FlowIndex> comes;
  bool may_pause = false;  ///< its way is broken: until it moves its frames are lost in any case
};

struct TransitionProblem {
  scenario::GateProblem flows;  ///< all streams, also those that come; these with a release of their phase, whichever
  std::vector<scenario::GateList> lists;  ///< by port of `flows`: what runs; without entries: all gates are open
  std::vector<FlowChange> changes;        ///< a flow is in one of them at most
  Duration begin;                         ///< nothing is written before; all that leaves has sent for two periods
  Duration lead;                          ///< a list is written at least so long before it holds
};

/// A port is given an administrative list (IEEE 802.1Q 8.6.9.3): AdminBaseTime is `holds_from`, a multiple of its
/// cycle, so that phases stay; CycleTimeExtension is 0.
struct WrittenList {
  std::uint32_t port = 0;
  scenario::GateList list;
  Duration written;     ///< ConfigChange is set
  Duration holds_from;  ///< ConfigChangeTime; a multiple of the former cycle, too, where that is not beyond
                        ///< longest_gate_cycle
};

/// The talker of a change begins, ends or moves.
struct TalkerSwitch {
  std::size_t change = 0;         ///< in TransitionProblem::changes
  std::optional<Duration> last;   ///< release of the last frame at the old times
  std::optional<Duration> first;  ///< release of the first one at the new times
};

/// Lists that are written at one instant, or talkers that change over when those hold.
struct TransitionStep {
  std::vector<WrittenList> lists;
  std::vector<TalkerSwitch> talkers;
};

struct Transition {
  std::vector<TransitionStep> steps;      ///< in order of time
  std::vector<scenario::GateList> lists;  ///< by port, at the end
  Duration end;                           ///< then all lists hold and nothing is under way at an old time
  std::vector<std::size_t> stuck;         ///< changes for which there is no order; then there are no steps
  std::string why;                        ///< of the first of these
};

/// Precondition: `lists` are those of the flows that no change brings, and the schedules at the beginning and at the
/// end are sound.
Transition plan_transition(const TransitionProblem& problem);

/// By flow: from the release of a frame until its last bit is at the last listener, as the windows say, without the
/// margin.
std::vector<Duration> latencies_of_windows(const scenario::GateProblem& flows);

}  // namespace takt::synthesis
