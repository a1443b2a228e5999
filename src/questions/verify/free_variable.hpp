// SPDX-License-Identifier: Apache-2.0
// What a scenario leaves open, and a worst case may choose.
//
// A run takes what is not said as 0: a stream without "offset", a Program without "offset" or "phases", calls at the
// very instants of the script. A plant promises none of it. So these are free:
//
//   phase of a talker      within its period, unless the stream has an "offset" (periodic talkers and bursts)
//   phase of a publisher   of each participant within the Program's cycle, unless the Program has an "offset", or
//   "phases" for this participant instant of a call      later by less than a cycle, and still before the next entry of
//   the script instant of a fault     of a link or node: later by less than the longest period, and still before the
//   next fault latency of a host      of transmission, reception and wake-up, where chance decides: as it has it,
//   always the least, always the greatest, or one of these jitter of a talker     the same in each frame, within the
//   stream's "jitter" losses on a link       where chance loses frames: as it has it, or all in one stretch as long as
//   the longest period, and no others frequency of a clock   where the scenario gives a range: as chance has it, the
//   lowest, or the highest seed                   all else that chance decides: oscillators that drift, gaps between
//   frames
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "scenario/resolved/resolved.hpp"

namespace takt::verify {

/// What a latency may be instead of what chance has; 1 ps apart, as values of a variable.
inline constexpr sim::Duration by_chance = sim::Duration::from_ps(0);
inline constexpr sim::Duration always_least = sim::Duration::from_ps(1);
inline constexpr sim::Duration always_greatest = sim::Duration::from_ps(2);
inline constexpr sim::Duration either_end = sim::Duration::from_ps(3);  ///< the least or the greatest, as chance has it

/// Something that is free: a time from 0 up to, but without, `range`.
struct FreeVariable {
  enum class Kind : std::uint8_t {
    talker,
    publisher,
    call,
    fault,
    host_latency,
    generator_latency,
    jitter,
    losses,
    frequency
  };
  enum class Latency : std::uint8_t { transmit, receive, wake_up };
  Kind kind{};
  std::size_t item = 0;         ///< in Scenario::streams, programs, script, faults, or network's nodes or generate
  std::size_t participant = 0;  ///< publishers: 0 the master, then the slaves
  sim::Duration range;
  std::string name;   ///< "phase of camera"
  Latency latency{};  ///< of latencies
  sim::Duration least = {};
  sim::Duration greatest = {};
  std::string node = {};  ///< of frequencies
  bool operator==(const FreeVariable&) const = default;
  bool is_latency() const { return kind == Kind::host_latency || kind == Kind::generator_latency; }
};

/// All that is free, but for the seed.
std::vector<FreeVariable> free_variables_of(const scenario::Resolved& resolved);

/// One of the runs that the scenario allows.
struct Choice {
  std::uint64_t seed = 1;
  std::vector<sim::Duration> values;  ///< by variable; 0 is what a run takes
  bool operator==(const Choice&) const = default;
};

/// The scenario in which the choice is made: a file of it replays the run. Precondition: the values lie within their
/// ranges.
scenario::Scenario scenario_of(const scenario::Scenario& scenario, std::span<const FreeVariable> variables,
                               const Choice& choice);

}  // namespace takt::verify
