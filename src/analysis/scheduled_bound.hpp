// Frames that come at known phases of a cycle: how long they wait at a port whose gates follow the same time.
//
// Frame k of a flow comes between first + k * period and so much later as `width` says. Whatever busy period a frame falls into begins with the arrival y of some frame; of the
// others those count that may come between y and the frame itself, at x. With the same frames in between, a later y and an earlier x are worse: all that matters are y at the
// latest arrivals and x at the earliest ones; and x = y, where a window ends just then.
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
  Ps work = 0;      ///< of a frame
};

/// When a frame can start, counted from `from`, if a busy period begins there and `before` is sent before it.
using StartFrom = std::function<Ps(Ps from, Ps before)>;

/// By flow, the longest wait from arrival to start. `cycle` is that of the gates, `ends` are when windows end in one; no busy period is longer than `busy`. Nothing if there are too many frames to look at.
std::optional<std::vector<Ps>> longest_waits(const std::vector<ScheduledFlow>& flows, Ps cycle, const std::vector<Ps>& ends, Ps busy, const StartFrom& start);

}  // namespace takt::analysis
