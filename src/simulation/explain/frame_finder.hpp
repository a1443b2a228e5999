// SPDX-License-Identifier: Apache-2.0
// Which frame a question is about: the slowest, the fastest, or the first that was lost. A run of its own finds it, of
// which only deliveries and drops are kept, so that
// afterwards one frame alone is followed, however long the run is.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>

#include "explain/way.hpp"
#include "scenario/resolved/resolved.hpp"

namespace takt::explain {

/// Asked between slices of a run; true: no more.
using Interrupted = std::function<bool()>;

struct FrameQuestion {
  enum class Which : std::uint8_t { slowest, lost, number };
  std::optional<models::StreamIndex> stream =
      {};                        ///< all streams but those of gPTP, if absent; with `number` there must be one
  Which which = Which::slowest;  ///< of all deliveries; the first that some listener misses, no copy of it having come;
                                 ///< that number
  std::uint64_t number = 0;
  TrueTime from = {};  ///< of frames that are produced then or later
};

/// A frame at one of its listeners.
struct Delivery {
  FrameName frame;
  models::NodeIndex listener;
  Duration latency;
};

struct FoundFrames {
  std::optional<Delivery> slowest;  ///< the first of those that took longest
  std::optional<Delivery> fastest;
  std::optional<FrameName>
      lost;  ///< of those that were dropped and that a listener misses, the one that was dropped first
  bool lost_has_copies = false;  ///< it was lost since all of its copies were
};

/// What a run of the scenario shows of the streams that are asked about, and of frames that are produced at `from` or
/// later; `which` and `number` do not count. Nothing if it was interrupted.
std::optional<FoundFrames> find_frames(const scenario::Resolved& resolved, const FrameQuestion& question,
                                       const Interrupted& interrupted);

}  // namespace takt::explain
