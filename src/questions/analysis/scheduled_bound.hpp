// SPDX-License-Identifier: Apache-2.0
// Frames that come at known phases of a cycle: how long they wait at a port whose gates follow the same time.
//
// Frame k of a flow comes between first + k * period and so much later as `width` says. Whatever busy period a frame
// falls into begins with the arrival y of some frame; of the others those count that may come between y and the frame
// itself, at x. With the same frames in between, a later y and an earlier x are worse: all that matters are y at the
// latest arrivals and x at the earliest ones; and x = y, where a window ends just then.
//
// Others of the class may come at any time. A busy period may begin with one of them too; with as many of them in
// between, a later y is worse again, so that y is as long before x as the jumps of their arrival curve.
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "analysis/picoseconds.hpp"

namespace takt::analysis {

struct ScheduledFlow {
  Ps first = 0;
  Ps period = 1;
  Ps width = 0;
  Ps work = 0;  ///< of a frame
};

/// The least common multiple of the periods and the cycle, or nothing if that is more than a million cycles.
std::optional<Ps> hyperperiod(const std::vector<Ps>& periods, Ps cycle);

/// What comes at no known phase: the most work in a closed interval, and the lengths at which that jumps, ascending, up
/// to the longest busy period.
struct UnscheduledWork {
  std::function<Ps(Ps length)> in;
  std::vector<Ps> jumps{0};
};

/// When a frame can start, counted from `from`, if a busy period begins there and `before` is sent before it.
using StartFrom = std::function<Ps(Ps from, Ps before)>;

/// By flow, the longest wait from arrival to start. `cycle` is that of the gates, `ends` are when windows end in one;
/// no busy period is longer than `busy`. Nothing if there are too many frames to look at.
std::optional<std::vector<Ps>> longest_waits(const std::vector<ScheduledFlow>& flows, Ps cycle,
                                             const std::vector<Ps>& ends, Ps busy, const StartFrom& start,
                                             const UnscheduledWork& others);

}  // namespace takt::analysis
