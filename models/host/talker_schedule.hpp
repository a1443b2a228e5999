// When a talker produces its frames.
#pragma once

#include <cstdint>
#include <variant>
#include <vector>

#include "models/ethernet/sizes.hpp"
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
using TalkerSchedule = std::variant<PeriodicSchedule, ExponentialSchedule, BurstSchedule, TraceSchedule>;

}  // namespace takt::models
