// SPDX-License-Identifier: Apache-2.0
// The state of frames and clocks at the instant of a trace record, for sinks that get records late.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "models/ethernet/frame.hpp"
#include "models/network.hpp"

namespace takt::models {

/// The state that belongs to one record. Frame numbers are those of the emitter: each is used again only after
/// Occurrence::ended.
struct Moment {
  Frame frame;                              ///< that the record names, if it names one
  std::span<const std::byte> payload = {};  ///< its octets, if the model holds them and somebody wants them
  std::uint32_t queued_frames = 0;          ///< in all queues of the port that the record names
  sim::Duration delay;                      ///< of `started`: LinkEnd::delay of the port's link
  sim::Duration node_delay;                 ///< the same: LinkEnd::node_delay
};

/// Where a sink reads state: in the network while records arrive as they happen, or in the attached moment.
class View {
 public:
  /// The network outlives it.
  explicit View(const Network& network) : network_(&network) {}
  /// Attaches the moment of each trace record.
  void look_at(const Moment& moment) { moment_ = &moment; }
  /// Whether Occurrence::ended is emitted.
  bool is_told_of_ends() const { return moment_ != nullptr; }

  // Of the present record.
  const Frame& frame(FrameIndex frame) const {
    return moment_ != nullptr ? moment_->frame : network_->traffic().frame(frame);
  }
  /// Precondition: the frame has a payload.
  std::span<const std::byte> payload(const Frame& frame) const {
    return moment_ != nullptr ? moment_->payload : network_->traffic().payload(frame.payload).view();
  }
  /// At the port that it names.
  std::uint32_t queued_frames(NodeIndex node, std::uint16_t port) const {
    return moment_ != nullptr ? moment_->queued_frames : queued_frames_now(*network_, node, port);
  }
  /// Of started: the delay of the link, and the share of the node behind it.
  sim::Duration delay(NodeIndex node, std::uint16_t port) const {
    return moment_ != nullptr ? moment_->delay : far_end(node, port).delay;
  }
  sim::Duration node_delay(NodeIndex node, std::uint16_t port) const {
    return moment_ != nullptr ? moment_->node_delay : far_end(node, port).node_delay;
  }

  static std::uint32_t queued_frames_now(const Network& network, NodeIndex node, std::uint16_t port) {
    const PortQueues& queues = network.ports(node)[port].queues();
    std::size_t frames = 0;
    for (TrafficClass q = 0; q < traffic_class_count; ++q) frames += queues.frames(q);
    return static_cast<std::uint32_t>(frames);
  }

 private:
  const LinkEnd& far_end(NodeIndex node, std::uint16_t port) const {
    return network_->ports(node)[port].link().reception().far_end;
  }

  const Network* network_;
  const Moment* moment_ = nullptr;
};

}  // namespace takt::models
