// SPDX-License-Identifier: Apache-2.0
// The seam to the communication stack: the simulated network, sockets or memory stand behind these two interfaces.
#pragma once

#include <cstdint>

#include "uadp/octets.hpp"

namespace takt::pubsub {

/// Where a NetworkMessage goes; the stack maps it to an address, a VLAN and a priority.
struct Destination {
  std::uint16_t writer_group_id = 0;
  std::uint8_t priority = 0;  ///< of the WriterGroup; higher is more urgent
  bool operator==(const Destination&) const = default;
};

/// Takes what is to be sent.
class PublishedData {
 public:
  virtual ~PublishedData() = default;
  /// The octets are the caller's and last until the call returns.
  virtual void publish(uadp::Octets network_message, const Destination& destination) = 0;
};

/// Gives what has been received.
class SubscribedData {
 public:
  virtual ~SubscribedData() = default;
  /// The next NetworkMessage, oldest first; nothing if there is none. The octets last until the next call.
  virtual uadp::Octets next() = 0;
};

}  // namespace takt::pubsub
