// SPDX-License-Identifier: Apache-2.0
// Can the frames of streams pass what polices them: flow meters, ATS schedulers, the cycle of cyclic queuing?
#pragma once

#include "scenario/resolved/resolved.hpp"

namespace takt::scenario {

/// A bucket or a cycle that no longest frame of a stream fits into is an error, a scheduler slower than its streams a
/// warning. To be called when the ingress of switches is there.
void check_policing(const Resolved& resolved, json::Diagnostics& diagnostics);

}  // namespace takt::scenario
