// SPDX-License-Identifier: Apache-2.0
// Do the frames of streams fit into the gate windows of the ports that they cross?
#pragma once

#include "scenario/resolved/resolved.hpp"

namespace takt::scenario {

/// Frames that can never be sent, because no window of their class is long enough, are errors. To be called when
/// streams, ingress, gates, script and faults are there.
void check_windows(const Resolved& resolved, json::Diagnostics& diagnostics);

}  // namespace takt::scenario
