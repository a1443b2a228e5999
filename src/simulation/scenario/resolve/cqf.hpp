// SPDX-License-Identifier: Apache-2.0
// Cyclic queuing and forwarding (IEEE 802.1Q Annex T) as what it is made of: a stream gate that spreads what comes in
// over several queues, cycle by cycle, and gate lists that send from one of them after the other.
//
// With k buffers what is received in cycle i waits in buffer i mod k and is sent in cycle i + k - 1. With two, a frame
// must be in before the cycle ends in which it was sent: sending stops a dead time before the end. With three and more
// receiving may lag behind sending by an offset, since the buffer that is filled then is not yet sent from.
#pragma once

#include <array>

#include "models/ingress/ingress_config.hpp"
#include "scenario/description/description.hpp"
#include "scenario/topology/topology.hpp"

namespace takt::scenario {

/// The times that a switch uses, given or found out from its links.
struct CqfTimes {
  Duration dead_time;
  Duration offset;
};
CqfTimes cqf_times(const Cqf& cqf, const Topology& topology, std::uint32_t node);

using ClassOfPriority = std::array<models::TrafficClass, 8>;

/// The stream gate: entry i gives the internal priority value whose class is classes[i].
models::StreamGateConfig cqf_stream_gate(const Cqf& cqf, const CqfTimes& times,
                                         const ClassOfPriority& class_of_priority);

/// The gates of every port: of the classes of CQF one at a time is open, all other classes always are.
models::GateConfig cqf_port_gates(const Cqf& cqf, const CqfTimes& times);

/// The priorities of the frames that CQF carries.
std::vector<models::Priority> cqf_priorities(const Cqf& cqf, const ClassOfPriority& class_of_priority);

}  // namespace takt::scenario
