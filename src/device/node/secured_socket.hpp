// SPDX-License-Identifier: Apache-2.0
// A socket whose messages are sealed when they are sent and opened when they have come; what is refused has no message,
// and counts.
#pragma once

#include <memory>

#include "node/node_security.hpp"
#include "node/socket.hpp"

namespace takt::node {

class SecuredSocket final : public Socket {
 public:
  /// `security` outlives it, and is used by nobody else at the same time.
  SecuredSocket(std::unique_ptr<Socket> socket, NodeSecurity& security)
      : socket_(std::move(socket)), security_(security) {}

  void publish(uadp::Octets message, const pubsub::Destination& destination) override;
  std::optional<Arrival> take() override;
  int file_descriptor() const override { return socket_->file_descriptor(); }
  /// Also messages that there was no key for.
  std::uint64_t send_failures() const override { return socket_->send_failures() + unsealed_; }
  std::string enable_launch_times(ClockName clock) override { return socket_->enable_launch_times(clock); }

 private:
  std::unique_ptr<Socket> socket_;
  NodeSecurity& security_;
  std::uint64_t unsealed_ = 0;
};

}  // namespace takt::node
