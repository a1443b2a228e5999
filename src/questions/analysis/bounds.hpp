// SPDX-License-Identifier: Apache-2.0
// The bounds of a scenario: latency and backlog of every stream by hop, and of every reaction. Start here.
//
//   const analysis::Bounds bounds = analysis::bound(resolved);
//   bounds.requirements[i].duration        // what resolved.requirements[i] can be at most, or why that is not known
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "analysis/assumption_ledger.hpp"
#include "analysis/host_times.hpp"
#include "scenario/resolved/resolved.hpp"

namespace takt::analysis {

struct BoundOptions {
  /// How far synchronised clocks may be from a time that all nodes on a way share, if no requirement "sync" or "clocks"
  /// of the scenario says it: two of them differ by up to twice that.
  sim::Duration clock_error = sim::Duration::from_ps(1'000'000);
  /// False: frames are taken for fluids, which they are not. For tests that must catch a wrong bound.
  bool counts_packets = true;
  /// Set by bound(): messages of DDS come within this time or not at all, and participants wake within it. Nothing:
  /// what they send has no curve, for the reason that follows.
  std::optional<sim::Duration> dds_within = {};
  std::string dds_late = {};
  /// Asked between ports; true ends the analysis: then nothing has a bound.
  std::function<bool()> interrupted = {};
};

/// One egress port on the way of a stream.
struct HopBound {
  models::NodeIndex node;
  std::uint16_t port = 0;
  std::string name;                           ///< "sw1:0 to robot"
  std::optional<sim::Duration> delay;         ///< from arrival at the port to the last bit on the wire
  std::optional<std::uint64_t> backlog_bits;  ///< of the stream's class at that port, preambles and gaps included
};

struct StreamBound {
  std::string name;
  models::StreamIndex index;
  std::optional<sim::Duration>
      latency;  ///< from production to delivery, at any listener: the lesser of the two analyses
  std::optional<sim::Duration> total_flow;                ///< the same by total-flow analysis, the sum of the hops
  std::optional<sim::Duration> separated_flow;            ///< and by separated-flow analysis, where that applies
  std::string separated_flow_reason;                      ///< why it does not
  sim::Duration least;                                    ///< no delivered frame is faster
  models::NodeIndex listener;                             ///< the one that the bound is of
  std::vector<std::optional<sim::Duration>> by_listener;  ///< as in the plan
  std::vector<HopBound> hops;                             ///< to that listener
  bool loses_nothing = false;        ///< queues have room for every backlog and nothing else drops its frames
  bool reaches_all = false;          ///< each frame comes to each listener: nothing is lost, or a copy is left
  bool loses_by_faults_only = true;  ///< would lose nothing if nothing failed
  std::string loss_reason;           ///< what may drop them, or the copies
  std::string reason;                ///< why there is no bound
  Assumptions assumptions;
};

/// A stream at one egress port of any of its ways, counted from production. Where several ways lead there (copies,
/// rerouting), of the slowest.
struct PassageBound {
  models::StreamIndex stream;
  models::NodeIndex node;
  std::uint16_t port = 0;
  models::TrafficClass traffic_class = 0;
  std::optional<sim::Duration> comes;  ///< to the port, at the latest
  std::optional<sim::Duration> left;   ///< the last bit is on the wire, at the latest
  bool is_held = false;                ///< by an ATS scheduler before it
};

/// What a participant of a Program adds to a notification, at most.
struct ParticipantBound {
  std::optional<sim::Duration> publish_wait;  ///< from a change of its word to the next publication
  std::optional<sim::Duration> initialise;    ///< in INIT
};

/// One queue of an egress port, and what may be in it or on the wire.
struct QueueBound {
  models::NodeIndex node;
  std::uint16_t port = 0;
  models::TrafficClass traffic_class = 0;
  std::optional<std::uint64_t> bits;  ///< preambles and gaps included
  std::optional<std::uint64_t> frames;
};

/// A part of a reaction's bound, in the order in which they happen.
struct ReactionPart {
  std::string what;
  sim::Duration duration;
};

struct ReactionBound {
  std::size_t program = 0;  ///< in resolved.programs
  scenario::Reaction kind = scenario::Reaction::start;
  handshake::Cause cause =
      handshake::Cause::command;  ///< of a halt also crash, cut, silence (since the last word that came) and restart
  bool of_tree = false;           ///< of the Program and all that are nested in it
  std::optional<sim::Duration>
      bound;  ///< from the instant of the cause to the moment at which all who live have reached the state
  std::vector<ReactionPart> parts;  ///< of the slowest chain; they sum up to the bound
  std::string reason;
  Assumptions assumptions;
};

/// From a publishing thread of an application to a subscribing one that is matched with it.
struct DeliveryBound {
  std::size_t from_application = 0, from_thread = 0;  ///< in resolved.applications
  std::size_t to_application = 0, to_thread = 0;
  std::optional<sim::Duration> one_way;  ///< from the call that writes until the sample is in the reader's history, of
                                         ///< one whose messages are not lost
  std::string reason;                    ///< why there is none
  /// Over DDS, of one whose messages are lost once: if the next HEARTBEAT, the ACKNACK that answers it and what is sent
  /// again come. Of samples behind it as well, which wait for it. Nothing over OPC UA.
  std::optional<sim::Duration> repaired;
  std::string repair_reason;  ///< why there is none
  bool reaches_all = false;   ///< no message of the way is lost, so that the one way is all
  std::string loss_reason;    ///< what may be lost
  Assumptions assumptions;
};

/// What a figure can be, in its unit; an end that is not there is not known.
struct FigureRange {
  std::optional<double> least;
  std::optional<double> greatest;
};

struct RequirementBound {
  std::optional<sim::Duration> duration;  ///< latency, jitter, reaction or synchronisation
  std::optional<std::uint64_t> count;     ///< dropped frames
  std::string reason;                     ///< why there is none
  Assumptions assumptions;
  std::optional<FigureRange> figure = {};  ///< of one on a figure; the reason is that of an end which it has not
};

struct Bounds {
  AssumptionLedger ledger;  ///< what becomes of the assumptions; what rests on a violated one has no bound here
  std::vector<StreamBound> streams;                         ///< by stream index
  std::vector<QueueBound> queues;                           ///< of classes that carry something
  std::vector<PassageBound> passages;                       ///< by stream, node and port, in this order
  std::vector<std::vector<ParticipantBound>> participants;  ///< by program; none with roles
  std::vector<ReactionBound> reactions;  ///< of each program: start, halt, suspend, resume, reset, then halts by cause;
                                         ///< of the outermost one of a tree then those of the tree
  std::vector<DeliveryBound> deliveries;       ///< of topics, by reader and what it hears
  std::vector<RequirementBound> requirements;  ///< by Resolved::requirements
  int rounds = 0;                              ///< until the fixed point
  std::uint64_t port_analyses = 0;             ///< what it took: ports, each as often as it was looked at
  bool is_interrupted = false;
  std::shared_ptr<const HostTimes> hosts;   ///< what the threads of processors add
  Assumptions every;                        ///< that all bounds need
  std::optional<sim::Duration> dds_within;  ///< of scenarios with DDS: no message is under way for longer, and no
                                            ///< participant wakes later; nothing: that is not known
};

/// Never fails: what cannot be bounded has a reason instead of a bound.
Bounds bound(const scenario::Resolved& resolved, const BoundOptions& options = {});

}  // namespace takt::analysis
