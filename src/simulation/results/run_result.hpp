// SPDX-License-Identifier: Apache-2.0
// What a run leaves behind: plain data, made once at the end, from which all reports are written.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "json/type.hpp"
#include "results/application_result.hpp"
#include "results/clock_result.hpp"
#include "results/cpu_result.hpp"
#include "results/ingress_result.hpp"
#include "sim/time.hpp"

namespace takt::results {

using sim::Duration;
using sim::TrueTime;

enum class Verdict : std::uint8_t {
  pass,
  fail,
  undecided,  ///< the run was interrupted before it could fail, or its clocks follow several grandmasters
};
const char* name_of(Verdict verdict);
inline constexpr const char* nothing_was_required = "nothing was required";

struct LatencySummary {
  Duration min;
  Duration mean;
  Duration p50;
  Duration p99;
  Duration max;
  Duration stddev;
};

struct HistogramBucket {
  Duration from;
  Duration to;  ///< included
  std::uint64_t count = 0;
};

struct StreamResult {
  std::string name;
  bool of_program = false;
  std::uint32_t listeners = 1;
  std::uint64_t sent = 0;
  std::uint64_t copies = 0;  ///< made by bridges for several listeners
  std::uint64_t delivered = 0;
  std::uint64_t in_flight = 0;               ///< copies under way at the end
  std::optional<Duration> oldest_in_flight;  ///< how long the oldest frame that some listener still waits for has been
                                             ///< under way; none if none is
  std::uint64_t lost =
      0;  ///< frames that no copy brings to a listener any more; copies that were dropped, where each is the only one
  bool has_copies = false;  ///< its frames may come several times: lost counts frames, dropped copies
  std::vector<std::pair<std::string, std::uint64_t>> dropped;  ///< copies by reason, only those that occurred
  std::optional<LatencySummary> latency;                       ///< none if nothing was delivered
  std::vector<HistogramBucket> histogram;
  std::uint64_t dropped_in_all() const {
    std::uint64_t sum = 0;
    for (const auto& [reason, count] : dropped) sum += count;
    return sum;
  }
};

struct ReactionResult {
  std::string kind;
  std::string initiator;  ///< node; of a tree: program, '/', node
  std::string cause;      ///< "command", "crash" ...: the spelling of a handshake::Cause
  TrueTime began;         ///< the instant of the cause
  std::optional<TrueTime> completed;
  bool superseded = false;  ///< something else was asked for before it was complete
  std::optional<Duration> duration() const { return completed ? std::optional(*completed - began) : std::nullopt; }
};

struct ViolationResult {
  TrueTime at;
  std::string invariant;
  std::string participant;
  std::string text;
};

/// From publishing process data to receiving what answers it.
struct RoundTripResult {
  std::string request;  ///< data set
  std::string reply;    ///< data set
  std::uint64_t count = 0;
  std::optional<LatencySummary> time;     ///< none if nothing was answered
  std::optional<LatencySummary> one_way;  ///< from publishing to the end of the work at the request
  std::vector<HistogramBucket> histogram;
};

/// A row of the time line: a call, a change of state ("dead" while the node has failed), or a fault.
struct TimelineEntry {
  TrueTime at;
  std::uint8_t participant = 0;
  std::string call;   ///< method and status, or empty
  std::string state;  ///< the new state, or empty
  std::string fault;  ///< what happens to the group's nodes and links, of no participant; or empty
};

/// An entry as result.json has it, with the participant's name.
struct TimelineRow {
  TrueTime at;
  std::string participant;
  std::string call;
  std::string state;
  std::string fault;
};

/// A role of a program got a node, or lost it.
struct BindingResult {
  TrueTime at;
  std::string role;
  std::string node;  ///< empty: nobody
};

struct ProgramResult {
  std::string name;
  std::string variant;
  Duration cycle;
  std::vector<std::string> participants;  ///< node names, the master first
  std::vector<std::string> states;        ///< at the end
  std::vector<ReactionResult> reactions;
  std::vector<ReactionResult>
      tree_reactions;                   ///< of it and all that are nested in it; the outermost program of a tree only
  std::vector<BindingResult> bindings;  ///< of a program with roles, in the order of time
  std::vector<ViolationResult> violations;
  bool violations_allowed = false;
  std::vector<TimelineEntry> timeline;
  std::uint64_t changes = 0;  ///< of state, in all; the time line keeps the first ones
  std::uint64_t process_data_received = 0;
  std::vector<RoundTripResult> round_trips;
};

/// What a requirement is about.
enum class RequirementKind : std::uint8_t {
  reaction,
  latency,
  jitter,
  dropped,
  delivered,
  sync,
  clocks,
  success,
  buffered,
  irregular,
  lost_in_a_row,
  late_in_a_row,
  met,
  figure,
  invariants
};

/// Limits on how many are missed one after another.
constexpr bool is_of_misses(RequirementKind kind) {
  return kind == RequirementKind::lost_in_a_row || kind == RequirementKind::late_in_a_row ||
         kind == RequirementKind::met;
}

/// A figure of the result and the limit that was asked of it, both in its unit.
struct FigureResult {
  std::string name;
  std::string unit;
  std::optional<double> found;  ///< none if the run has no such figure
  double asked = 0;
  bool is_upper = true;
  std::optional<double> within = {};  ///< it must equal what was asked, so far
};

struct RequirementResult {
  RequirementKind kind{};
  RequirementKind taken_as{};  ///< the same; of a limit on the figure of a greatest latency, or of a longest reaction,
                               ///< that of these
  std::optional<std::size_t> requirement = {};  ///< in Resolved::requirements; none: a Program's invariants
  std::string subject;                          ///< as RequiredFigure has it; the Program of invariants
  std::string text;
  std::string name = {};  ///< that the scenario gives it: "REQ-12"; may be empty
  Verdict verdict = Verdict::pass;
  std::optional<Duration> measured;
  std::optional<Duration> limit;
  std::optional<Duration> least_measured = {};  ///< of one that asks for a value, not for the greatest
  std::optional<Duration> least_limit = {};
  Duration from = {};                       ///< what began then or later counts
  std::string remark;                       ///< what was counted, or why it failed without a figure
  std::optional<FigureResult> figure = {};  ///< of one that asks for a figure
};

/// As people look for it: "REQ-12: stream camera latency at most 7ms".
std::string titled(const std::string& name, const std::string& text);
inline std::string titled(const RequirementResult& requirement) { return titled(requirement.name, requirement.text); }

struct PortResult {
  std::string node;
  std::uint16_t port = 0;
  std::string peer;
  std::uint64_t frames = 0;
  std::uint64_t dropped = 0;
  std::uint32_t queue_peak = 0;            ///< most frames in one queue
  double utilisation = 0;                  ///< share of the simulated time that the medium was taken
  std::uint64_t fragments_cut = 0;         ///< how often a frame was cut for an express one
  std::uint64_t frames_cut_through = 0;    ///< began to leave before they had come wholly
  std::uint64_t bad_fcs_forwarded = 0;     ///< of those, damaged ones
  std::uint64_t transmission_overrun = 0;  ///< were still being sent when their gate closed
};

/// The queue of a traffic class at an egress port that has held a frame. The frame that is being sent does not count.
struct QueueResult {
  std::string node;
  std::uint16_t port = 0;
  std::string peer;
  std::uint8_t traffic_class = 0;
  std::uint32_t frames = 0;  ///< most that waited
  std::uint32_t octets = 0;  ///< DA to FCS
};

struct RunResult {
  std::string version;
  std::string scenario;
  std::uint64_t seed = 0;
  Duration simulated;
  Duration wanted;
  bool partial = false;
  std::uint64_t digest = 0;
  std::uint64_t events = 0;
  Verdict verdict = Verdict::pass;
  bool nothing_required = false;  ///< neither by the scenario nor by Programs; the verdict is pass then, and says so
  Duration from = {};             ///< the figures are of what began then or later
  std::vector<RequirementResult> requirements;
  std::vector<StreamResult> streams;
  std::vector<ProgramResult> programs;
  std::vector<ApplicationResult> applications;  ///< gateways behind the others
  std::vector<CpuResult> cpus;                  ///< of hosts whose threads take time
  std::vector<SignalResult> signals;
  std::vector<PortResult> ports;    ///< those that sent or dropped something
  std::vector<QueueResult> queues;  ///< those that have held a frame
  std::vector<std::pair<std::string, std::uint64_t>>
      dropped;                                           ///< frames of all streams by reason, only those that occurred
  std::vector<ClockResult> clocks;                       ///< of nodes with gPTP
  std::vector<GrandmasterResult> grandmasters;           ///< who gave the time when
  std::vector<GptpLinkResult> gptp_links;                ///< ports of nodes with gPTP
  std::vector<ClockDifferenceResult> clock_differences;  ///< by group of nodes
  std::vector<IngressResult> ingress;                    ///< of switches whose ingress has met a frame
  RedundancyResult redundancy;
};

// What result.json holds of them: the tables.
const json::Record& describe(json::Type<RunResult>);
const json::Record& describe(json::Type<RequirementResult>);
const json::Record& describe(json::Type<StreamResult>);
const json::Record& describe(json::Type<LatencySummary>);
const json::Record& describe(json::Type<HistogramBucket>);
const json::Record& describe(json::Type<ProgramResult>);
const json::Record& describe(json::Type<ReactionResult>);
const json::Record& describe(json::Type<BindingResult>);
const json::Record& describe(json::Type<ViolationResult>);
const json::Record& describe(json::Type<TimelineRow>);
const json::Record& describe(json::Type<RoundTripResult>);
const json::Record& describe(json::Type<PortResult>);
const json::Record& describe(json::Type<QueueResult>);

}  // namespace takt::results
