// SPDX-License-Identifier: Apache-2.0
#include "pubsub/memory_stack.hpp"

#include <algorithm>

#include "sim/check.hpp"

namespace takt::pubsub {

MemoryPort::MemoryPort(MemoryMedium& medium, std::size_t most_messages, std::size_t most_octets)
    : medium_(medium),
      most_octets_(most_octets),
      octets_((most_messages + 1) * most_octets),
      lengths_(most_messages + 1) {
  TAKT_CHECK(most_messages > 0 && most_octets > 0, "a port has room for a message");
  medium_.ports_.push_back(this);
}

MemoryPort::~MemoryPort() { std::erase(medium_.ports_, this); }

void MemoryPort::publish(uadp::Octets network_message, const Destination&) {
  for (MemoryPort* port : medium_.ports_)
    if (port != this) port->put(network_message);
}

/// One place of the ring stays free: it may hold the message that was given last.
void MemoryPort::put(uadp::Octets network_message) {
  if (waiting_ + 1 == lengths_.size() || network_message.size() > most_octets_ || network_message.empty()) {
    ++dropped_;
    return;
  }
  const std::size_t place = (first_ + waiting_) % lengths_.size();
  std::copy(network_message.begin(), network_message.end(),
            octets_.begin() + static_cast<std::ptrdiff_t>(place * most_octets_));
  lengths_[place] = network_message.size();
  ++waiting_;
}

uadp::Octets MemoryPort::next() {
  if (waiting_ == 0) return {};
  const uadp::Octets message = uadp::Octets(octets_).subspan(first_ * most_octets_, lengths_[first_]);
  first_ = (first_ + 1) % lengths_.size();
  --waiting_;
  return message;
}

}  // namespace takt::pubsub
