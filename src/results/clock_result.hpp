// What a run says of the nodes' clocks.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "json/type.hpp"
#include "sim/time.hpp"

namespace takt::results {

/// A row of a clock's history: from then on that grandmaster, that state.
struct ClockChangeResult {
  sim::TrueTime at;
  std::string grandmaster;
  std::string state;
};

/// One node: offsets are its clock less that of its grandmaster, since it was locked first.
struct ClockResult {
  std::string node;
  std::string grandmaster;                    ///< at the end
  std::string state;                          ///< at the end
  std::optional<sim::Duration> time_to_lock;
  std::uint64_t samples = 0;
  sim::Duration least;
  sim::Duration greatest;
  sim::Duration mean;
  sim::Duration rms;
  std::int64_t frequency_error_ppt = 0;       ///< at the end: rate of its clock against the grandmaster's, in 10^-12
  std::uint64_t steps = 0;
  std::uint64_t messages = 0;                 ///< sent
  std::vector<ClockChangeResult> changes;     ///< the first 4096
};

// What result.json holds of them: the tables.
const json::Record& describe(json::Type<ClockResult>);
const json::Record& describe(json::Type<ClockChangeResult>);

}  // namespace takt::results
