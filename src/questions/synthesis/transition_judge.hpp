// SPDX-License-Identifier: Apache-2.0
// A transition, simulated frame by frame: is any frame of a scheduled stream lost or late, and do the ports end with
// the lists that they shall have?
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "synthesis/transition_scenario.hpp"

namespace takt::synthesis {

/// How a stream fared while everything changed.
struct CarriedStream {
  std::string name;
  std::uint64_t sent = 0;
  std::uint64_t delivered = 0;
  std::uint64_t lost = 0;         ///< to what has failed
  Duration planned;               ///< latency from when a frame is due
  std::optional<Duration> least;  ///< of the run
  std::optional<Duration> greatest;
};

struct TransitionVerdict {
  std::vector<CarriedStream> streams;
  std::uint64_t frames = 0;        ///< sent by scheduled streams
  std::vector<std::string> wrong;  ///< one sentence each; empty: nothing is
};

/// Runs the scenario. What is wrong with it as a scenario is wrong, too.
TransitionVerdict judge_transition(const TransitionScenario& transition);

}  // namespace takt::synthesis
