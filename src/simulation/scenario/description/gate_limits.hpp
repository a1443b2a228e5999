// SPDX-License-Identifier: Apache-2.0
// "gate_limits" of a node.
#pragma once

#include <cstdint>
#include <optional>

#include "json/fields.hpp"
#include "sim/time.hpp"

namespace takt::scenario {

/// What a device can do with the gate control lists of its ports.
struct GateLimits {
  json::Source where;
  std::optional<std::uint32_t> entries;         ///< of a list, at most
  std::optional<sim::Duration> least_interval;  ///< no entry is shorter
  std::optional<sim::Duration> granularity;     ///< entries and cycles are multiples of it
  std::optional<std::uint8_t> queues;           ///< different traffic classes at a port, at most
  bool operator==(const GateLimits&) const = default;
};

const json::Object& describe(json::Type<GateLimits>);

}  // namespace takt::scenario
