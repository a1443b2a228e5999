// SPDX-License-Identifier: Apache-2.0
// What the members of a Program send each other: its streams.
#pragma once

#include "scenario/resolved/resolved.hpp"
#include "scenario/resolve/stream_builder.hpp"

namespace takt::scenario {

/// Lays the streams of a program whose members and their skills are known, and notes its process data. False if one
/// cannot be laid (reported).
bool lay_program_streams(Resolved& resolved, StreamBuilder& builder, ResolvedProgram& program,
                         json::Diagnostics& diagnostics);

}  // namespace takt::scenario
