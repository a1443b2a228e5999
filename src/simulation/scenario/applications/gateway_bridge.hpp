// SPDX-License-Identifier: Apache-2.0
// A gateway on a simulated host: a gateway::Channel that a crash empties, and what all of them saw.
#pragma once

#include <optional>

#include "application/topic_shape.hpp"
#include "gateway/channel.hpp"
#include "scenario/resolved/resolved_applications.hpp"

namespace takt::scenario {

class GatewayBridge {
 public:
  /// The settings outlive it.
  GatewayBridge(const ResolvedGateway& settings, const application::TopicShape& from,
                const application::TopicShape& to);

  /// The buffer is empty.
  void start();
  void crash();
  /// A value of the one topic, and that of the other that is to be sent now, if any; valid until the next call.
  void receive(uadp::Octets value, sim::LocalTime now) { channel_->receive(value, now); }
  std::optional<uadp::Octets> pull(sim::LocalTime now);
  gateway::ChannelFigures figures() const;

 private:
  const ResolvedGateway* settings_;
  gateway::TypeMapping mapping_;
  std::optional<gateway::Channel> channel_;
  gateway::ChannelFigures before_;  // what crashes have taken
};

}  // namespace takt::scenario
