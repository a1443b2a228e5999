// SPDX-License-Identifier: Apache-2.0
// What the ports of a node have not: traffic classes beyond their number, gates where there are none.
#pragma once

#include "json/diagnostics.hpp"
#include "scenario/resolved/resolved.hpp"

namespace takt::scenario {

/// Reports shapers, limits and the like of classes that a node does not have, and lists for nodes without gates. Gates
/// of classes that are not there mean nothing.
void check_port_abilities(const Resolved& resolved, json::Diagnostics& diagnostics);

}  // namespace takt::scenario
