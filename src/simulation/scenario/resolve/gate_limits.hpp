// SPDX-License-Identifier: Apache-2.0
// What the gates of a device can do ("gate_limits"), for automatic gates and for lists that the scenario says.
#pragma once

#include "json/diagnostics.hpp"
#include "scenario/resolved/gate_problem.hpp"
#include "scenario/resolved/resolved.hpp"

namespace takt::scenario {

/// What is told of gates that a device cannot have.
inline constexpr const char* beyond_the_device = "gates beyond what the device can do";

/// What is told of a list that no port has.
inline constexpr const char* too_long_a_cycle = "gates with too long a cycle";

/// What a port of the node takes of automatic gates.
ListLimits list_limits_of(const TopologyNode& node);

/// Tells of lists in "egress", "gates" and "script" that their devices do not take, and of ports whose frames are in
/// more classes than the device has queues. To be called when the gates are there.
void check_gate_limits(const Resolved& resolved, json::Diagnostics& diagnostics);

}  // namespace takt::scenario
