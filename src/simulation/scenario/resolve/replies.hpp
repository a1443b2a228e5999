// SPDX-License-Identifier: Apache-2.0
// Process data that answers process data: who replies to what, and how long the work before it takes.
#pragma once

#include "scenario/resolved/resolved.hpp"

namespace takt::scenario {

/// Reports senseless times of processing, of all hosts.
void check_processing(const Topology& topology, json::Diagnostics& diagnostics);
/// Reports what is wrong with replies, by the names in the description: whatever else is wrong with the program.
void check_replies(const Program& program, json::Diagnostics& diagnostics);
/// Fills replies and processing of the program, whose participants and process data are resolved.
void resolve_replies(const Topology& topology, ResolvedProgram& program);

}  // namespace takt::scenario
