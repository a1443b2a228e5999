// SPDX-License-Identifier: Apache-2.0
// What a scenario requires of its streams, with windows or without, as bounds see it.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "analysis/bounds.hpp"
#include "scenario/resolved/resolved.hpp"

namespace takt::synthesis {

/// A required latency, jitter, loss or delivery of a stream.
struct StreamRequirement {
  enum class State : std::uint8_t {
    kept,    ///< by every run that the bounds allow
    broken,  ///< in the run of the schedule, or what is bounded is more than what is required, and some run is better
    unbounded,  ///< nothing is known
  };
  std::size_t requirement = 0;  ///< in Resolved::requirements
  std::string text;             ///< "stream camera latency at most 7ms"
  std::string stream;           ///< "*": all
  State state = State::unbounded;
  std::optional<sim::Duration> bound;           ///< of a time
  std::optional<sim::Duration> limit;           ///< of a time
  std::optional<sim::Duration> simulated = {};  ///< of a time: the greatest in the run of the schedule
  std::string reason;                           ///< why it is not kept
  /// By how much the bound exceeds the limit; of what is no time, nothing.
  sim::Duration excess() const { return bound && limit && *bound > *limit ? *bound - *limit : sim::Duration(); }
};

/// In the order of the scenario. `bounds` are those of `resolved`.
std::vector<StreamRequirement> stream_requirements(const scenario::Resolved& resolved, const analysis::Bounds& bounds);

/// Whether the scenario requires anything of streams.
bool requires_of_streams(const scenario::Resolved& resolved);

/// "stream camera latency at most 7ms: at most 7.2ms is bounded"; empty if none is broken.
std::string first_broken(const std::vector<StreamRequirement>& requirements);

/// Of several schedules the one is closest to what is required in which fewest requirements break, and of these the one
/// that exceeds them least.
struct Shortfall {
  std::size_t broken = 0;
  sim::Duration excess;  ///< of all together
  auto operator<=>(const Shortfall&) const = default;
};
Shortfall shortfall_of(const std::vector<StreamRequirement>& requirements);

}  // namespace takt::synthesis
