// SPDX-License-Identifier: Apache-2.0
// What discovery costs and how long it takes.
#pragma once

#include <cstdint>
#include <map>

#include "dds/message/guid.hpp"
#include "sim/time.hpp"

namespace takt::dds {

/// Messages (UDP payloads; one to several places counts for each of them) and octets of them.
struct MessageCount {
  std::uint64_t messages = 0;
  std::uint64_t octets = 0;
  friend MessageCount operator-(const MessageCount& a, const MessageCount& b) {
    return {a.messages - b.messages, a.octets - b.octets};
  }
  MessageCount& operator+=(const MessageCount& other) {
    messages += other.messages;
    octets += other.octets;
    return *this;
  }
  bool operator==(const MessageCount&) const = default;
};

struct DiscoveryFigures {
  MessageCount participants_sent;  ///< SPDP: announcements, answers, farewells
  MessageCount endpoints_sent;     ///< SEDP with its HEARTBEATs and ACKNACKs; of a server: all that it forwards, too
  MessageCount liveliness_sent;    ///< ParticipantMessages, the same
  std::uint64_t participants_received = 0;  ///< submessages
  std::uint64_t endpoints_received = 0;
  std::uint64_t liveliness_received = 0;
  std::uint64_t refused = 0;    ///< data that was not understood
  std::uint64_t forwarded = 0;  ///< of a server: data of participants and endpoints told to a client
  std::uint64_t leases_expired = 0;

  sim::LocalTime started_at;
  /// When each participant and each endpoint was found; since started_at this is the time to match. What is lost stays.
  std::map<Guid, sim::LocalTime> found_at;

  MessageCount sent() const {
    MessageCount sum = participants_sent;
    sum += endpoints_sent;
    sum += liveliness_sent;
    return sum;
  }
};

}  // namespace takt::dds
