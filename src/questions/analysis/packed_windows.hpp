// SPDX-License-Identifier: Apache-2.0
// Whole frames in the windows of a gate, counted window by window where work by the second says nothing: a class whose
// frames come just as fast as its windows take them, but do not fill them.
//
// Frames go first in, first out; of each window that finds some waiting, they take one place behind the other until the
// next one does not fit. Which sequence of frames makes the last of them wait for longest is found by walking all that
// the arrival curves allow. Time is cut into slots from the instant at which a busy period begins; a walk goes from
// slot to slot, sends frames of flows that may send some by then, and remembers how far the next frame of each flow is
// away (in slots), the window and what of it is taken. Of all walks that lead to the same point only the one that is
// furthest behind matters. If some circle of points leaves the class further behind each time there is no bound,
// otherwise the walk ends. See docs/bounds.md, "Frame by frame".
#pragma once

#include <optional>
#include <vector>

#include "analysis/picoseconds.hpp"

namespace takt::analysis {

struct PackedFlow {
  Ps work = 0;    ///< of its longest frame on the medium, gap included
  Ps period = 0;  ///< in a closed interval of length t at most (t + jitter) / period + 1 frames come
  Ps jitter = 0;
};

/// Windows in true time, by the worst clock.
struct PackedWindow {
  Ps room = 0;     ///< from when others have left the medium at the latest until it closes at the earliest
  Ps longest = 0;  ///< from when it opens until it closes, at most
  Ps to_next = 0;  ///< from the start of the room to that of the next window, at most
  Ps closed = 0;   ///< from when it closes to the start of the next window's room, at most
};

struct PackedWindows {
  std::vector<PackedWindow> windows;  ///< of one cycle
  Ps blocked = 0;                     ///< what a frame of another class may take when a busy period begins
  Ps gap = 0;                         ///< of the work of a frame: need not fit into its window
};

/// By flow, the longest time from the arrival to the last bit. Nothing if there is none, or too much to look at.
std::optional<std::vector<Ps>> delays_of_packed(const std::vector<PackedFlow>& flows, const PackedWindows& windows);

}  // namespace takt::analysis
