// Faults: from the description to actions of the script, impairments of links and additional talkers.
#pragma once

#include "scenario/resolve/resolved.hpp"

namespace takt::scenario {

/// Adds what goes wrong to resolved.plan and resolved.script, which is not sorted afterwards. To be called when nodes, links and
/// streams are there. Links that do not exist, unknown nodes and streams are diagnostics.
void resolve_faults(Resolved& resolved, json::Diagnostics& diagnostics);

}  // namespace takt::scenario
