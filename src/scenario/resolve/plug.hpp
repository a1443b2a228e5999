// Programs with roles: who may have which role, and the streams between the master and all that may.
#pragma once

#include "json/diagnostics.hpp"
#include "scenario/resolve/resolved.hpp"
#include "scenario/resolve/stream_builder.hpp"

namespace takt::scenario {

/// Adds the program to the resolved ones, or reports why it cannot be. `publishers`: PublisherIds that are taken so far.
void resolve_roles(Resolved& resolved, StreamBuilder& builder, ResolvedProgram program, std::size_t& publishers, json::Diagnostics& diagnostics);
/// Keys that a program with slaves has no use for.
void refuse_without_roles(const Program& program, json::Diagnostics& diagnostics);
/// After all programs have been resolved: a node offers its skills to one program.
void check_candidates(const Resolved& resolved, json::Diagnostics& diagnostics);
/// "join" or "leave" of the script.
void resolve_plug_action(Resolved& resolved, const ScriptEntry& entry, json::Diagnostics& diagnostics);

}  // namespace takt::scenario
