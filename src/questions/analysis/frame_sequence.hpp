// SPDX-License-Identifier: Apache-2.0
// Frames of one class that come at known times, one after the other: the no-wait argument, and what becomes of it where
// clocks are wrong.
//
// The frames of a class leave in the order in which they come. Where that order is certain, frame n starts by
//
//   S(n) = the first instant at or after max(latest arrival of n, S(n - 1) + work of n - 1) at which n itself fits into
//   a window
//
// and since all of this only grows with each arrival, the latest arrivals are the worst ones, and frames that do not
// come only help. A window may be as long as its frame: what counts is whether this frame fits, not the longest of its
// class. A frame that finds its window open starts as it comes, and is as certain behind the port as before it.
//
// Frames are in a certain order if the one has surely come before the other, or if they are of one train. Those that
// are not are taken together: each waits for all others of its cluster, in the time that is left of windows without the
// longest of them.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "analysis/scheduled_bound.hpp"

namespace takt::analysis {

struct SequencedFlow : ScheduledFlow {
  Ps last_bit = 0;  ///< from the start of a frame to its last bit
  std::optional<std::uint32_t>
      train;  ///< frames of one train come in order, each turn by rank, whatever the clocks say
  std::uint32_t rank = 0;
};

/// The windows of a class, by the clock of the port.
struct SequenceWindows {
  struct Window {
    Ps from = 0;
    Ps until = 0;
    Ps taken = 0;  ///< of its start, by frames of other classes that began before it, and the gap behind them
  };
  Ps cycle = 1;
  Ps base = 0;  ///< when a cycle begins
  bool is_always_open = false;
  std::vector<Window> windows;  ///< of one cycle, ascending
  Ps error = 0;                 ///< the clock shows the time of the arrivals within so much
};

/// A flow's frames, counted from when they come at the earliest.
struct SequencedTimes {
  Ps wait = 0;      ///< the longest from arrival to start
  Ps earliest = 0;  ///< start
  Ps latest = 0;
};

struct SequenceBound {
  std::vector<SequencedTimes> flows;
  Ps backlog = 0;  ///< work that may be there at once, waiting or on the medium
  std::int64_t backlog_frames = 0;
  bool is_exact = false;  ///< the order of all frames is certain, and nothing but their gate keeps them waiting
};

/// What other classes may send before a frame of this class that waits for so long. Empty: nothing, their gates are
/// closed.
using OthersWork = std::function<Ps(Ps length)>;

/// Nothing, and why, if frames may miss their windows without end, or if there are too many of them.
std::optional<SequenceBound> bound_sequence(const std::vector<SequencedFlow>& flows, const SequenceWindows& windows,
                                            const OthersWork& others, std::string& reason);

}  // namespace takt::analysis
