// SPDX-License-Identifier: Apache-2.0
// Who follows frames over the cuts of a divided run.
#pragma once

#include <cstdint>

#include "models/ethernet/frame.hpp"
#include "sim/event.hpp"

namespace takt::models {

/// Called by one part, on its thread. Frames of one direction arrive in the order in which they left, each once, so
/// counting at both ends identifies them.
class CrossingWatcher {
 public:
  virtual ~CrossingWatcher() = default;
  /// A copy of the frame leaves for another part, where it will be `arrival`.
  virtual void left(std::uint32_t to, const sim::Event& arrival, FrameIndex frame) = 0;
  /// It has been taken over, before the time of its arrival.
  virtual void came(std::uint32_t from, const sim::Event& arrival, FrameIndex frame) = 0;
  /// The last copy of a frame that this part had has left: its record is about to be free.
  virtual void over(FrameIndex frame) = 0;
};

}  // namespace takt::models
