// SPDX-License-Identifier: Apache-2.0
// Offsets that nobody has to invent: for streams that may begin when it suits, the phases at which their frames meet no
// others. First fit over the hyperperiod: one after the other takes the first phase that is free at all ports of its
// way.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "scenario/gates/crossings.hpp"
#include "scenario/resolved/gate_problem.hpp"

namespace takt::scenario {

struct OffsetProblem {
  GateProblem gates;  ///< releases of streams that are movable are those with an offset of 0
  Waiting waiting = Waiting::at_gates;
  std::vector<std::vector<std::uint32_t>>
      movable;  ///< streams that get one offset together: what a participant publishes at one instant
};

/// Frames of a movable and of another stream meet at a port, whatever offset is chosen or at the one that is least bad.
struct Meeting {
  std::uint32_t stream = 0;
  std::uint32_t other = 0;
  std::uint32_t port = 0;
};

/// What was chosen for one entry of `movable`.
struct ChosenOffset {
  sim::Duration offset;           ///< a whole number of ns, less than the period
  std::vector<Meeting> meetings;  ///< each pair of streams and port once; empty: its frames meet nobody
};

/// By entry of `movable`. Two streams meet if any of their frames do, at any time: phases repeat with the greatest
/// common divisor of both periods. Those with the shortest periods and the longest transmissions choose first; who
/// finds nothing chooses first in the next of a few rounds. Effort is limited by counts: where many periods have small
/// common divisors a phase that is free may stay unfound. Where no round suits all, the round with the fewest meetings
/// counts, and who finds nothing gets the offset with the fewest.
std::vector<ChosenOffset> choose_offsets(const OffsetProblem& problem);

}  // namespace takt::scenario
