// SPDX-License-Identifier: Apache-2.0
// One egress port: how long a frame can take from its arrival at the queue to its last bit on the wire, whatever the
// phases.
//
// All amounts are time on the medium of this port, preamble and inter-packet gap included; frames arrive whole, at one
// instant (packetiser). What a class waits for: one frame of a lower class (blocking), all that comes to higher classes
// until it starts, what came to its own class before (FIFO), and what its gate, credit and preemption take away. See
// docs/bounds.md for the formulas and why they hold.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "analysis/frame_arrivals.hpp"
#include "models/egress/port_config.hpp"
#include "sim/units.hpp"

namespace takt::analysis {

/// How far the clock of the port's node may be wrong.
struct ClockQuality {
  std::int64_t rate_ppt = 0;     ///< its frequency is off by up to so many parts in 10^12
  std::int64_t slowest_ppt = 0;  ///< and by at least and at most so many, signed: both within rate_ppt
  std::int64_t fastest_ppt = 0;
  Ps error = 0;  ///< it shows true time within so much, if it is synchronised
  bool is_synchronised = true;
};

/// Frames that come to the port through one link. They cannot come faster than it carries them (line shaping).
struct IncomingLink {
  std::optional<Ps> octet_time;  ///< nothing: no such limit, for example from the host's own programs
  bool is_mixed = false;  ///< frames are preempted or cut through there: one more frame may come at the same time
};

/// When the frames of a flow come, if that is known: between first + k * period and `width` later.
struct ArrivalPhase {
  Ps first = 0;
  Ps period = 0;
  Ps width = 0;
  std::uint32_t clock =
      0;  ///< whose time that is: 0 that which all synchronised clocks follow, otherwise that of a clock of its own
  std::int64_t rate_ppt = 0;  ///< how far that time may run from true time, in parts in 10^12
  bool operator==(const ArrivalPhase&) const = default;
};

/// Frames of a flow that come or leave cycle by cycle, as cyclic queuing and forwarding sends them: at most so many
/// between first + k * period and `width` later, by the time that all synchronised clocks follow.
struct CyclicFrames {
  Ps first = 0;
  Ps period = 0;
  Ps width = 0;
  std::int64_t frames = 0;
  Ps sent_from = 0;  ///< when the cycle k = 0 begins in which the port before sends them
  bool operator==(const CyclicFrames&) const = default;
};

struct PortFlow {
  FrameArrivals arrivals;
  std::optional<ArrivalPhase> phase = {};
  std::optional<CyclicFrames> cyclic = {};  ///< of what the port before sends by cyclic queuing and forwarding
  sim::Octets frame{0};                     ///< DA to FCS; the longest one
  models::TrafficClass lowest_class = 0;    ///< two where cyclic queuing and forwarding takes turns
  models::TrafficClass highest_class = 0;
  std::size_t link = 0;                     ///< index in PortTraffic::links
  bool uses_cqf = false;                    ///< the stream gate of cyclic queuing and forwarding has given it its class
  std::optional<std::uint32_t> train = {};  ///< frames of one train come by rank in each turn, whatever the clocks say
  std::uint32_t rank = 0;
  std::optional<sim::Octets> shortest = {};  ///< frame, if they are as long as each other
};

/// A port's part in cyclic queuing and forwarding (see scenario/resolve/cqf.hpp).
struct CqfPort {
  Ps cycle = 0;
  Ps base = 0;  ///< when a cycle of sending begins
  int buffers = 2;
  Ps dead_time = 0;
  Ps offset = 0;
  Ps forwarding_delay = 0;
  models::ClassSet classes = 0;
};

struct PortTraffic {
  std::vector<IncomingLink> links;
  std::vector<PortFlow> flows;
};

struct PortModel {
  Ps octet_time = 0;
  const models::PortConfig* config = nullptr;
  std::vector<models::GateConfig> more_gates = {};  ///< lists that the script will set; a bound holds for each list
  ClockQuality clock;
  std::optional<CqfPort> cqf;
  Ps late_by =
      0;  ///< frames of timed classes that come so much later may be eligible before (bridges: jitter, clock steps)
  models::ClassSet unordered = 0;  ///< timed classes in which frames without launch times overtake
  bool counts_packets = true;  ///< false: bits leave as they come, no frame is waited for. Wrong, for tests of tests
};

/// In which cycle a frame is sent by cyclic queuing and forwarding. Lengths of true time.
struct SendingCycle {
  CyclicFrames leaves;  ///< last bits
  Ps least_wait = 0;    ///< from the arrival to the start of that cycle; negative: the cycle may have begun
  Ps greatest_wait = 0;
  bool follows = false;  ///< the port before has cycles of the same length, so the next two are known
  Ps least_step = 0;     ///< from the start of the cycle in which the port before sent the frame
  Ps greatest_step = 0;
  Ps least_sent = 0;  ///< from the start of the cycle to the last bit
  Ps greatest_sent = 0;
  bool operator==(const SendingCycle&) const = default;
};

struct PortFlowBound {
  Ps delay = unbounded_ps;  ///< from arrival to the last bit, preamble included
  Ps least_delay = 0;
  std::optional<ArrivalPhase> leaves = {};  ///< when the last bits do, where a schedule of gates says it
  std::optional<SendingCycle> cycle = {};   ///< of cyclic queuing and forwarding
};

struct PortClassBound {
  bool is_used = false;
  Ps backlog = unbounded_ps;        ///< time on the medium
  std::int64_t backlog_frames = 0;  ///< meaningful if the backlog is bounded
  std::string reason;               ///< why it is unbounded
};

struct PortBound {
  std::vector<PortFlowBound> flows;  ///< as in the traffic
  std::array<PortClassBound, models::traffic_class_count> classes;
};

PortBound bound_port(const PortModel& model, const PortTraffic& traffic);

}  // namespace takt::analysis
