// SPDX-License-Identifier: Apache-2.0
// A schedule: the way of each stream and when it starts on each link.
#pragma once

#include <map>
#include <optional>
#include <vector>

#include "schedule/problem.hpp"

namespace takt::schedule {

/// What a margin means: a frame is held until its gate opens and must be there a margin before (held), or nothing
/// waits, and frames are two margins further apart (flowing).
enum class GateTiming : std::uint8_t { held, flowing };

/// A stream in a schedule.
struct Placement {
  std::vector<LinkIndex> route;  ///< a tree, each link behind the one that it continues
  std::vector<std::vector<Ps>>
      starts;  ///< by link of the route: of repetition 0, or of all repetitions within the hyperperiod
  std::vector<std::uint8_t> classes;  ///< by link of the route
};

struct GateEntry {
  Ps interval = 0;
  std::uint8_t open = 0;  ///< bit c: class c
  bool operator==(const GateEntry&) const = default;
};

/// A gate control list; its cycle begins at 0 and is the sum of its intervals.
struct GateList {
  Ps cycle = 0;
  std::vector<GateEntry> entries;
};

struct Solution {
  GateTiming timing = GateTiming::held;
  std::vector<std::optional<Placement>> streams;  ///< as in the problem; empty: not scheduled
  std::map<LinkIndex, GateList> gates;            ///< of links that scheduled frames cross, if lists were asked for
};

}  // namespace takt::schedule
