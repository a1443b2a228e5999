// SPDX-License-Identifier: Apache-2.0
// A socket that follows its interface: an adapter that is plugged in again, or a VLAN interface that is made anew, is
// another one to the kernel, and sockets of the old one neither hear nor send.
#pragma once

#include "node/socket.hpp"

namespace takt::node {

class FollowingSocket final : public Socket {
 public:
  /// Null, and `problem` says why.
  static std::unique_ptr<FollowingSocket> open(const Transport& transport, std::string& problem);

  int file_descriptor() const override { return socket_->file_descriptor(); }
  std::optional<Arrival> take() override { return socket_->take(); }
  void publish(uadp::Octets message, const pubsub::Destination& destination) override;
  std::uint64_t send_failures() const override { return failures_before_ + socket_->send_failures(); }
  std::string enable_launch_times(ClockName clock) override;

  /// Looks for the interface, now and then. What has changed, for people; "" if nothing has.
  std::string look();
  /// "": the transport names none.
  const std::string& interface() const { return name_; }
  bool is_there() const { return is_there_; }
  std::uint64_t bound_again() const { return bound_again_; }

 private:
  FollowingSocket(const Transport& transport, std::unique_ptr<Socket> socket, std::string name, unsigned index)
      : transport_(transport), socket_(std::move(socket)), name_(std::move(name)), index_(index) {}

  Transport transport_;
  std::unique_ptr<Socket> socket_;
  std::string name_;
  unsigned index_;  ///< of the interface that it is bound to
  bool is_there_ = true;
  std::optional<ClockName> launch_clock_;
  std::uint64_t bound_again_ = 0;
  std::uint64_t failures_before_ = 0;  ///< of sockets before
};

}  // namespace takt::node
