// What the streams ask of each link.
#pragma once

#include "scenario/resolve/resolved.hpp"

namespace takt::scenario {

/// Fills resolved.ports. A direction of a link that is asked for more than its rate is an error, or a warning if the
/// scenario allows overload; above 90 % it is a warning.
void resolve_demand(Resolved& resolved, json::Diagnostics& diagnostics);

}  // namespace takt::scenario
