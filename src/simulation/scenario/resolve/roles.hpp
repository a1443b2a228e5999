// SPDX-License-Identifier: Apache-2.0
// Programs with roles: who may have which role.
#pragma once

#include "json/diagnostics.hpp"
#include "scenario/resolved/resolved.hpp"
#include "scenario/resolve/stream_builder.hpp"

namespace takt::scenario {

/// Finds the members of the program, or reports why it cannot be.
void resolve_roles(const Resolved& resolved, StreamBuilder& builder, ResolvedProgram& program,
                   json::Diagnostics& diagnostics);
/// After all programs have been resolved: a node offers its skills to one program.
void check_candidates(const Resolved& resolved, json::Diagnostics& diagnostics);
/// "join" or "leave" of the script; nothing if nobody of that name may (reported).
std::optional<ResolvedAction> membership_of(const Resolved& resolved, const ScriptEntry& entry,
                                            json::Diagnostics& diagnostics);

}  // namespace takt::scenario
