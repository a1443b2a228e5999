// SPDX-License-Identifier: Apache-2.0
// What the ingress of switches and the redundancy of streams counted in a run: plain data, like run_result.hpp.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "json/type.hpp"
#include "sim/time.hpp"

namespace takt::results {

/// A stream filter (IEEE 802.1Q 8.6.5.3). matching = passing_sdu + not_passing_sdu; passing_sdu = passing +
/// not_passing.
struct StreamFilterResult {
  std::string stream;                    ///< name, or empty: any
  std::optional<std::uint8_t> priority;  ///< none: any
  std::uint64_t matching = 0;
  std::uint64_t passing = 0;  ///< the stream gate
  std::uint64_t not_passing = 0;
  std::uint64_t passing_sdu = 0;
  std::uint64_t not_passing_sdu = 0;
  std::uint64_t red = 0;                 ///< discarded by the flow meter, among the passing
  bool blocked_due_to_oversize = false;  ///< latched
};

struct StreamGateResult {
  std::string name;
  std::uint64_t passed = 0;
  std::uint64_t closed = 0;  ///< came while it was closed
  std::uint64_t octets_exceeded = 0;
  bool closed_due_to_invalid_rx = false;       ///< latched
  bool closed_due_to_octets_exceeded = false;  ///< latched
};

struct FlowMeterResult {
  std::string name;
  std::array<std::uint64_t, 3> frames{};  ///< green, yellow, red
  std::uint64_t discarded = 0;
  bool marks_all_red = false;  ///< latched
};

struct AtsSchedulerResult {
  std::string name;
  std::uint64_t passed = 0;
  std::uint64_t discarded = 0;  ///< would have stayed too long
  sim::Duration longest_hold;   ///< greatest eligibility time minus arrival
};

/// The ingress of a switch; tables in the order of the scenario.
struct IngressResult {
  std::string node;
  std::uint64_t unidentified = 0;  ///< frames of no stream of its table
  std::vector<StreamFilterResult> filters;
  std::vector<StreamGateResult> gates;
  std::vector<FlowMeterResult> meters;
  std::vector<AtsSchedulerResult> ats;
};

/// Where a stream is split into members.
struct SplitResult {
  std::string node;
  std::string stream;
  std::size_t members = 0;
  std::uint64_t frames = 0;
  std::uint64_t copies = 0;  ///< made beyond them
};

/// The counters of a sequence recovery function (IEEE 802.1CB 7.4.3).
struct RecoveryCounters {
  std::uint64_t passed = 0;
  std::uint64_t discarded = 0;
  std::uint64_t out_of_order = 0;
  std::uint64_t rogue = 0;  ///< outside the history; among the discarded
  std::uint64_t lost = 0;   ///< numbers that nobody has seen, those before the first frame not counted
  std::uint64_t tagless = 0;
  std::uint64_t resets = 0;  ///< time-outs; the reset at the start is none
};

/// Latent error detection (7.4.4).
struct LatentErrorResult {
  std::uint32_t paths = 0;
  std::uint64_t errors = 0;  ///< tests that failed
  std::uint64_t resets = 0;
  std::optional<sim::TrueTime> first;  ///< when the first error was signalled
};

/// Where the members of a stream become one again.
struct RecoveryResult {
  struct Individual {                     ///< of one member at one reception port
    std::optional<std::uint16_t> member;  ///< none: frames of no member's address
    std::uint16_t port = 0;
    RecoveryCounters counters;
  };
  std::string node;
  std::string stream;
  RecoveryCounters counters;
  std::optional<LatentErrorResult> latent_errors;
  std::vector<Individual> individual;
};

struct RedundancyResult {
  std::vector<SplitResult> splits;
  std::vector<RecoveryResult> recoveries;
};

// What result.json holds of them: the tables.
const json::Record& describe(json::Type<IngressResult>);
const json::Record& describe(json::Type<StreamFilterResult>);
const json::Record& describe(json::Type<StreamGateResult>);
const json::Record& describe(json::Type<FlowMeterResult>);
const json::Record& describe(json::Type<AtsSchedulerResult>);
const json::Record& describe(json::Type<RedundancyResult>);
const json::Record& describe(json::Type<SplitResult>);
const json::Record& describe(json::Type<RecoveryResult>);
const json::Record& describe(json::Type<RecoveryCounters>);
const json::Record& describe(json::Type<LatentErrorResult>);
const json::Record& describe(json::Type<RecoveryResult::Individual>);

}  // namespace takt::results
