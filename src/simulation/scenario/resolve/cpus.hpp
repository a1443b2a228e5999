// SPDX-License-Identifier: Apache-2.0
// The processors of hosts: which thread runs what.
#pragma once

#include "scenario/resolved/resolved.hpp"

namespace takt::scenario {

/// Plans the processors of all hosts that have one and enters the threads of what runs on them. Behind Programs and
/// applications.
void resolve_cpus(Resolved& resolved, json::Diagnostics& diagnostics);

}  // namespace takt::scenario
