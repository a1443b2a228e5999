// SPDX-License-Identifier: Apache-2.0
// Who is better: system identities and priority vectors, IEEE 802.1AS-2020 10.3.2 to 10.3.5.
#pragma once

#include <compare>
#include <cstdint>

#include "models/gptp/identity.hpp"
#include "models/gptp/message.hpp"

namespace takt::models::gptp {

/// Compared from the first member to the last; the smaller wins.
struct SystemIdentity {
  std::uint8_t priority1 = 248;  // 255: cannot be grandmaster
  ClockQuality quality = {};
  std::uint8_t priority2 = 248;
  ClockIdentity clock = {};
  auto operator<=>(const SystemIdentity&) const = default;
};

struct PriorityVector {
  SystemIdentity root = {};
  std::uint16_t steps_removed = 0;
  PortIdentity source = {};  // of the port that sends
  std::uint16_t port = 0;    // of the port that receives
  auto operator<=>(const PriorityVector&) const = default;

  /// What an Announce that arrives at `port` says.
  static PriorityVector of(const Announce& announce, std::uint16_t port) {
    return {{announce.grandmaster_priority1, announce.grandmaster_quality, announce.grandmaster_priority2,
             announce.grandmaster},
            announce.steps_removed,
            announce.header.source,
            port};
  }
  /// The path to the grandmaster that leads through that port.
  PriorityVector one_step_further() const {
    PriorityVector further = *this;
    ++further.steps_removed;
    return further;
  }
};

}  // namespace takt::models::gptp
