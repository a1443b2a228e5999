// SPDX-License-Identifier: Apache-2.0
// What applications with threads, and the signals that they drive, did in a run: plain data, like run_result.hpp.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "json/type.hpp"
#include "sim/time.hpp"

namespace takt::results {

/// Tests of a criterion: in each window happenings are counted against those expected, at most as many as these.
struct CriterionResult {
  sim::Duration window;
  std::uint64_t tests = 0;
  std::uint64_t expected = 0;  ///< in all tests
  std::uint64_t counted = 0;
  std::uint64_t beyond = 0;  ///< happened in windows with more than expected, beyond those
  std::uint64_t windows_below = 0;
  std::uint64_t windows_above = 0;
  std::uint64_t discarded = 0;    ///< tests
  std::optional<double> percent;  ///< none without a test
};

struct DurationSummary {
  std::uint64_t count = 0;
  sim::Duration min;
  sim::Duration mean;
  sim::Duration max;
  sim::Duration deviation;  ///< standard deviation
};

struct ThreadResult {
  std::string name;
  std::string topic;
  bool publishes = false;
  sim::Duration every;
  std::uint64_t activations = 0;
  std::uint64_t done = 0;
  std::uint64_t missed = 0;
  std::optional<DurationSummary> response;  ///< of the calls that took place
  CriterionResult calls;                    ///< criterion 1
  std::uint64_t published = 0;              ///< samples, of a publishing thread
  std::uint64_t refused = 0;
  std::uint64_t timed_out = 0;  ///< waited for room for too long: not published
  std::uint64_t arrived = 0;    ///< samples that calls found, of a subscribing thread
  std::uint64_t buffered = 0;
  std::uint64_t overwritten = 0;
  std::uint64_t lost = 0;
  std::optional<std::uint64_t> filtered = {};  ///< of a subscription with a content filter
  std::optional<CriterionResult> values;       ///< criterion 2, of a subscription that gets all
  bool measures_round_trips = false;
  std::optional<DurationSummary> round_trip;  ///< of the values that have come back
};

/// A participant of DDS.
struct ParticipantResult {
  std::uint32_t domain = 0;
  std::uint64_t messages_sent = 0;
  std::uint64_t octets_sent = 0;  ///< of RTPS messages
  std::uint64_t messages_received = 0;
  std::uint64_t heartbeats_sent = 0;
  std::uint64_t acknacks_sent = 0;
  std::uint64_t resent = 0;              ///< samples or fragments
  std::uint64_t discovery_messages = 0;  ///< sent, among them
  std::uint64_t discovery_octets = 0;
  std::uint64_t participants_found = 0;
  std::uint64_t participants_lost = 0;
  std::uint64_t matches = 0;                   ///< of its endpoints with others
  std::optional<sim::Duration> time_to_match;  ///< from its last start to the last match since
  std::uint64_t deadlines_missed = 0;
  std::uint64_t liveliness_lost = 0;
  std::uint64_t samples_rejected = 0;
  std::uint64_t writes_timed_out = 0;
  std::vector<std::string> incompatible;  ///< endpoints that did not match, and why; each reason once
};

/// The shared buffer of a gateway. received = forwarded + overwritten + dropped + stale + waiting.
struct BufferResult {
  std::uint64_t received = 0;
  std::uint64_t forwarded = 0;
  std::uint64_t overwritten = 0;
  std::uint64_t dropped = 0;
  std::uint64_t stale = 0;
  std::uint64_t not_mapped = 0;  ///< came, and could not be mapped
  sim::Duration age_min;         ///< of what was forwarded
  sim::Duration age_mean;
  sim::Duration age_max;
};

/// A topic that a persistence service keeps.
struct KeptResult {
  std::string topic;
  std::uint64_t received = 0;  ///< samples, from their writers
  std::uint64_t restored = 0;  ///< samples that its last start found in its storage
  std::uint64_t kept = 0;      ///< samples at the end
};

struct ApplicationResult {
  std::string name;
  std::string node;
  bool is_gateway = false;
  bool is_service = false;  ///< a persistence service
  std::vector<ThreadResult> threads;
  std::vector<ParticipantResult> participants;
  std::optional<BufferResult> buffer;  ///< of a gateway
  std::vector<KeptResult> kept;        ///< of a persistence service
};

/// A digital output, in true time.
struct SignalResult {
  std::string name;
  sim::Duration nominal;  ///< length of a pulse; a period is twice that
  std::optional<DurationSummary> pulses;
  std::optional<DurationSummary> periods;  ///< from rise to rise
  std::uint64_t irregular_pulses = 0;      ///< more than 10 % off
  std::uint64_t irregular_periods = 0;
  std::vector<std::pair<sim::TrueTime, bool>> edges;  ///< the first 10 000; true: rise
  /// Share of all pulses in percent; none without a pulse.
  std::optional<double> irregular_percent() const {
    if (!pulses) return std::nullopt;
    return 100.0 * static_cast<double>(irregular_pulses) / static_cast<double>(pulses->count);
  }
};

// What result.json holds of them: the tables.
const json::Record& describe(json::Type<ApplicationResult>);
const json::Record& describe(json::Type<ThreadResult>);
const json::Record& describe(json::Type<CriterionResult>);
const json::Record& describe(json::Type<DurationSummary>);
const json::Record& describe(json::Type<ParticipantResult>);
const json::Record& describe(json::Type<BufferResult>);
const json::Record& describe(json::Type<KeptResult>);
const json::Record& describe(json::Type<SignalResult>);

}  // namespace takt::results
