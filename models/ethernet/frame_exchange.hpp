// SPDX-License-Identifier: Apache-2.0
// Where a link ends whose receiver acts in another part of a divided run.
#pragma once

#include <cstdint>

#include "models/ethernet/frame.hpp"
#include "sim/event.hpp"

namespace takt::models {

class FrameExchange {
 public:
  virtual ~FrameExchange() = default;
  /// The frame, a copy of which ends here, will be at the node for which `arrival` is (NodeEvent::frame_arrived, with
  /// all but the frame of its argument).
  virtual void send(std::uint32_t part, const sim::Event& arrival, FrameIndex frame) = 0;
};

}  // namespace takt::models
