// SPDX-License-Identifier: Apache-2.0
// Figures: what a participant has sent and received.
#pragma once

#include <array>

#include "dds/message/message_status.hpp"
#include "dds/message/submessage.hpp"

namespace takt::dds {

/// Counts by kind of submessage.
struct SubmessageCounts {
  std::array<std::uint64_t, 0x17> of{};
  void count(SubmessageKind kind) { ++of[static_cast<std::size_t>(kind)]; }
  std::uint64_t operator[](SubmessageKind kind) const { return of[static_cast<std::size_t>(kind)]; }
};

struct Figures {
  SubmessageCounts sent;
  SubmessageCounts received;
  std::uint64_t messages_sent = 0;         ///< a message to several locators counts once
  std::uint64_t datagrams_sent = 0;        ///< a message to several locators counts once for each
  std::uint64_t datagram_octets_sent = 0;  ///< the same in octets of RTPS messages
  std::uint64_t messages_received = 0;
  std::uint64_t octets_sent = 0;  ///< of RTPS messages
  std::uint64_t octets_received = 0;
  std::uint64_t resent = 0;      ///< samples or fragments sent again because a reader asked
  MessageStatusCounts verdicts;  ///< of messages received
};

}  // namespace takt::dds
