// SPDX-License-Identifier: Apache-2.0
// What the streams ask of each link.
#pragma once

#include "scenario/resolved/resolved.hpp"

namespace takt::scenario {

/// Of the directions of links that carry something; nodes, ports, streams and ingress are there. One that is asked for
/// more than its rate is an error, or a warning if the scenario allows overload; above 90 % it is a warning.
std::vector<PortDemand> demands_of(const Resolved& resolved, json::Diagnostics& diagnostics);

}  // namespace takt::scenario
