// SPDX-License-Identifier: Apache-2.0
// When a talker produces its frames.
#pragma once

#include <cstdint>
#include <memory>
#include <variant>
#include <vector>

#include "models/ethernet/sizes.hpp"
#include "sim/distribution.hpp"
#include "sim/time.hpp"

namespace takt::models {

/// Frame k is produced at offset + k * period + a uniform draw from [0, jitter]. jitter <= period.
struct PeriodicSchedule {
  sim::Duration offset;
  sim::Duration period;
  sim::Duration jitter;
};
/// Exponentially distributed gaps; the first frame comes one gap after the offset.
struct ExponentialSchedule {
  sim::Duration offset;
  sim::Duration mean;
};
/// Gaps of any distribution; the first frame comes one gap after the offset. Talkers are many and small, so the
/// distribution stands apart.
struct RandomGapSchedule {
  sim::Duration offset;
  std::shared_ptr<const sim::Distribution> gap;
};
/// At offset + k * period, `frames` frames, `spacing` apart (0: all at the same instant).
struct BurstSchedule {
  sim::Duration offset;
  sim::Duration period;
  std::uint32_t frames = 1;
  sim::Duration spacing;
};
/// Frames at given times with given payloads, ascending.
struct TraceSchedule {
  struct Entry {
    sim::LocalTime time;
    Octets payload;
  };
  std::vector<Entry> entries;
};
using TalkerSchedule =
    std::variant<PeriodicSchedule, ExponentialSchedule, BurstSchedule, TraceSchedule, RandomGapSchedule>;

}  // namespace takt::models
