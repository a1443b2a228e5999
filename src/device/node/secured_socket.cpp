// SPDX-License-Identifier: Apache-2.0
#include "node/secured_socket.hpp"

namespace takt::node {

void SecuredSocket::publish(uadp::Octets message, const pubsub::Destination& destination) {
  const uadp::Octets sealed = security_.seal(message);
  if (sealed.empty())
    ++unsealed_;
  else
    socket_->publish(sealed, destination);
}

std::optional<Arrival> SecuredSocket::take() {
  auto arrival = socket_->take();
  if (!arrival || arrival->verdict != wire::Verdict::taken) return arrival;
  const NodeSecurity::Opened opened = security_.open(arrival->message);
  arrival->verdict = opened.verdict;
  if (opened.verdict == wire::Verdict::taken)
    arrival->message = opened.clear;  // of one that is refused its headers still say of whom
  return arrival;
}

}  // namespace takt::node
