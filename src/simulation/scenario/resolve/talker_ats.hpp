// SPDX-License-Identifier: Apache-2.0
// ATS schedulers at talkers: from the description of hosts and stations to the plan.
#pragma once

#include "scenario/resolved/resolved.hpp"

namespace takt::scenario {

/// Fills plan.talker_ats. To be called when streams, their paths and the egress ports are there (resolve_ingress).
/// Unknown streams, streams of other talkers, ports that do not mind eligibility times, bursts smaller than a frame and
/// rates above the link's are diagnostics.
void resolve_talker_ats(Resolved& resolved, json::Diagnostics& diagnostics);

}  // namespace takt::scenario
