// SPDX-License-Identifier: Apache-2.0
// Policing, ATS, CQF and redundancy: from the description to the ingress of each switch and to the stacks of hosts.
#pragma once

#include "scenario/resolved/resolved.hpp"

namespace takt::scenario {

/// Fills plan.ingress_configs and the nodes' references to them, plan.host_splits and plan.host_recoveries, and gives
/// the ports of switches with CQF their gates. To be called when the streams are there, before windows are checked.
/// Unknown names, configurations that let no frame of a stream pass and those that mean nothing are diagnostics.
void resolve_ingress(Resolved& resolved, json::Diagnostics& diagnostics);

}  // namespace takt::scenario
