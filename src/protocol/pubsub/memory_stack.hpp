// SPDX-License-Identifier: Apache-2.0
// The stack in memory: ports on a common medium, each hears all others. For tests, examples and Programs in one
// process.
#pragma once

#include <memory>
#include <vector>

#include "pubsub/stack.hpp"

namespace takt::pubsub {

class MemoryMedium;

/// One participant's connection. What it publishes waits at all other ports until they ask.
class MemoryPort final : public PublishedData, public SubscribedData {
 public:
  /// Room for so many NetworkMessages of so many octets; it allocates here and nowhere else.
  MemoryPort(MemoryMedium& medium, std::size_t most_messages = 64, std::size_t most_octets = 1500);
  ~MemoryPort() override;
  MemoryPort(const MemoryPort&) = delete;
  MemoryPort& operator=(const MemoryPort&) = delete;

  void publish(uadp::Octets network_message, const Destination& destination) override;
  uadp::Octets next() override;

  /// Messages that found no room, or were too long for it.
  std::uint64_t dropped() const { return dropped_; }

 private:
  void put(uadp::Octets network_message);

  MemoryMedium& medium_;
  std::size_t most_octets_;
  std::vector<std::byte> octets_;     ///< a ring of messages
  std::vector<std::size_t> lengths_;  ///< of the messages in the ring
  std::size_t first_ = 0;
  std::size_t waiting_ = 0;
  std::uint64_t dropped_ = 0;
};

/// The ports that hear each other, in the order in which they came. It outlives them.
class MemoryMedium {
 private:
  friend class MemoryPort;
  std::vector<MemoryPort*> ports_;
};

}  // namespace takt::pubsub
