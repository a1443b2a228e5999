// SPDX-License-Identifier: Apache-2.0
#include "node/following_socket.hpp"

#include <net/if.h>

namespace takt::node {
namespace {

std::unique_ptr<Socket> open_any(const Transport& transport, std::string& problem) {
  return std::visit([&problem](const auto& each) { return open_socket(each, problem); }, transport);
}

std::string named_interface(const Transport& transport) {
  if (const auto* const udp = std::get_if<UdpTransport>(&transport)) return udp->interface.value_or("");
  return std::get<EthernetTransport>(transport).interface;
}

unsigned index_of_interface(const std::string& name) { return name.empty() ? 0 : ::if_nametoindex(name.c_str()); }

}  // namespace

std::unique_ptr<FollowingSocket> FollowingSocket::open(const Transport& transport, std::string& problem) {
  const std::string name = named_interface(transport);
  const unsigned index = index_of_interface(name);
  auto socket = open_any(transport, problem);
  return socket ? std::unique_ptr<FollowingSocket>(new FollowingSocket(transport, std::move(socket), name, index))
                : nullptr;
}

void FollowingSocket::publish(uadp::Octets message, const pubsub::Destination& destination) {
  socket_->set_launch_time(launch_ns_);
  socket_->publish(message, destination);
}

std::string FollowingSocket::enable_launch_times(ClockName clock) {
  const std::string refused = socket_->enable_launch_times(clock);
  if (refused.empty()) launch_clock_ = clock;
  return refused;
}

std::string FollowingSocket::look() {
  if (name_.empty()) return "";
  const unsigned now = index_of_interface(name_);
  const bool was_there = is_there_;
  is_there_ = now != 0;
  if (!is_there_) return was_there ? "interface " + name_ + " is gone" : "";
  if (now == index_) return was_there ? "" : "interface " + name_ + " is there again";
  std::string problem;
  auto socket = open_any(transport_, problem);
  if (!socket) {
    is_there_ = false;  // its address may come later; it is tried again
    return was_there ? "interface " + name_ + " was made anew: " + problem : "";
  }
  if (launch_clock_) problem = socket->enable_launch_times(*launch_clock_);
  failures_before_ += socket_->send_failures();
  socket_ = std::move(socket);
  index_ = now;
  ++bound_again_;
  return "interface " + name_ + " was made anew: bound again" +
         (problem.empty() ? "" : ", without launch times: " + problem);
}

}  // namespace takt::node
