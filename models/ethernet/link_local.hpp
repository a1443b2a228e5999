// SPDX-License-Identifier: Apache-2.0
// Frames that end at the next node and belong to its control plane, such as those of gPTP (IEEE 802.1Q Table 8-1:
// addresses that bridges do not forward).
#pragma once

#include <cstdint>

#include "models/ethernet/frame.hpp"
#include "sim/simulation.hpp"

namespace takt::models {

/// Takes what link-local frames bring to a node.
class LinkLocalReceiver {
 public:
  virtual ~LinkLocalReceiver() = default;
  /// The frame came through that port of the node; its last bit was in at `last_bit`. The receiver accounts for it and
  /// releases it.
  virtual void receive(sim::Simulation& simulation, FrameIndex frame, std::uint16_t port, sim::TrueTime last_bit) = 0;
};

/// Notified when a link-local frame begins to leave a port: the first bit of its preamble, at the present instant. Only
/// then a one-step message gets its time, so the payload may still change.
class LinkLocalSender {
 public:
  virtual ~LinkLocalSender() = default;
  virtual void transmission_starts(sim::Simulation& simulation, sim::ComponentId port, FrameIndex frame) = 0;
};

}  // namespace takt::models
