// SPDX-License-Identifier: Apache-2.0
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
  std::string grandmaster;  ///< at the end
  std::string state;        ///< at the end
  std::optional<sim::Duration> time_to_lock;
  bool has_led = false;  ///< another node followed it at some time
  std::uint64_t samples = 0;
  sim::Duration least;
  sim::Duration greatest;
  std::optional<sim::TrueTime> greatest_at;  ///< of the greatest either way
  sim::Duration mean;
  sim::Duration rms;
  std::int64_t frequency_error_ppt = 0;  ///< at the end: rate of its clock against the grandmaster's, in 10^-12
  std::uint64_t steps = 0;
  std::uint64_t messages = 0;              ///< sent
  std::vector<ClockChangeResult> changes;  ///< the first 4096
  /// A grandmaster is locked to itself and never to another one: then nothing is missing.
  bool was_never_to_lock() const { return !time_to_lock && (has_led || state == "grandmaster"); }
};

/// A change of who gives the time.
struct GrandmasterResult {
  sim::TrueTime at;
  std::string node;
  std::string
      event;  ///< "leads": another node is locked to it; "lost": it went down; "replaced": nobody follows it any more
};

/// A port of a node with gPTP, and whether its link is asCapable at the end.
struct GptpLinkResult {
  std::string node;
  std::uint16_t port = 0;
  std::string peer;
  bool is_capable = false;
  std::string why_not;                      ///< empty: it is
  sim::TrueTime since;                      ///< it has been as it is
  std::optional<sim::Duration> link_delay;  ///< as measured; none: never
  std::optional<sim::Duration> threshold;   ///< none: no delay is too long
};

/// How far the clocks of a group of nodes were apart at most: two of them at one look.
struct ClockDifferenceResult {
  std::string name;  ///< "all", "ways", or the nodes of a requirement
  std::uint64_t samples = 0;
  std::optional<sim::Duration> greatest;  ///< none: not looked at
  std::optional<sim::TrueTime> at;
  std::string behind;
  std::string ahead;
};

// What result.json holds of them: the tables.
const json::Record& describe(json::Type<ClockResult>);
const json::Record& describe(json::Type<ClockChangeResult>);
const json::Record& describe(json::Type<GrandmasterResult>);
const json::Record& describe(json::Type<GptpLinkResult>);
const json::Record& describe(json::Type<ClockDifferenceResult>);

}  // namespace takt::results
