// The clocks of the nodes and gPTP: from the description to the plan.
#pragma once

#include "scenario/resolve/resolved.hpp"

namespace takt::scenario {

/// Gives every node in resolved.plan its clock and its gPTP. To be called when nodes and links are there. Unknown nodes, roles that
/// cannot be, domains twice and the like are diagnostics.
void resolve_clocks(Resolved& resolved, json::Diagnostics& diagnostics);

}  // namespace takt::scenario
