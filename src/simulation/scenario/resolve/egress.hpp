// SPDX-License-Identifier: Apache-2.0
// Gates, shapers and maximum SDU sizes of ports: from the description to the configuration of each port.
#pragma once

#include "scenario/resolved/resolved.hpp"

namespace takt::scenario {

/// The gates as management sets them. A list whose cycle is shorter than a tick or whose entries are all beyond it is a
/// diagnostic.
models::GateConfig gate_config_of(const Gates& gates, json::Diagnostics& diagnostics);

/// Gives every end of a link in resolved.plan its port configuration, on top of those of the nodes. A shaper faster
/// than its link, a neighbour that is none and a class configured twice are diagnostics.
void resolve_egress(Resolved& resolved, json::Diagnostics& diagnostics);

/// The classes of streams with a launch time wait for it at their talkers; they cannot share bandwidth. To be called
/// when the talkers are there.
void add_launch_classes(Resolved& resolved, json::Diagnostics& diagnostics);

/// Whether credit can grow as fast as an idle slope of the whole cycle asks for while the gate is open.
bool slope_is_possible(const models::CreditBased& shaper, models::TrafficClass q, const models::GateConfig& gates,
                       DataRate rate);
/// The same of all ports. To be called when all gates are there, those of CQF too.
void check_slopes(const Resolved& resolved, json::Diagnostics& diagnostics);

/// Cut-through and sequence recovery do not go together at one switch. To be called when the streams are there.
void check_cut_through(const Resolved& resolved, json::Diagnostics& diagnostics);

}  // namespace takt::scenario
