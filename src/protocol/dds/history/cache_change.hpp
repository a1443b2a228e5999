// SPDX-License-Identifier: Apache-2.0
// CacheChange: one change of an instance, as it stands in a history (DDSI-RTPS 2.5, 8.2.1).
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "dds/history/instance_key.hpp"
#include "dds/message/sequence_number.hpp"
#include "sim/time.hpp"

namespace takt::dds {

/// What a change does to its instance (9.6.3.9, PID_STATUS_INFO: bit 0 disposed, bit 1 unregistered).
enum class ChangeKind : std::uint8_t { alive = 0, disposed = 1, unregistered = 2, disposed_unregistered = 3 };

constexpr bool disposes(ChangeKind kind) { return (static_cast<unsigned>(kind) & 1u) != 0; }
constexpr bool unregisters(ChangeKind kind) { return (static_cast<unsigned>(kind) & 2u) != 0; }

struct CacheChange {
  SequenceNumber number;
  ChangeKind kind = ChangeKind::alive;
  InstanceKey key;
  sim::LocalTime source;                                  ///< when it was written, by the clock of this participant
  sim::LocalTime expires = sim::LocalTime::never();       ///< source + lifespan
  std::optional<OriginalWriter> original = std::nullopt;  ///< of a change that a persistence service brings
  std::vector<std::byte> payload;  ///< serialized payload with its encapsulation header; empty if not alive
};

}  // namespace takt::dds
