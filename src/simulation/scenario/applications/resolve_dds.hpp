// SPDX-License-Identifier: Apache-2.0
// Participants, their discovery, and the streams between them.
#pragma once

#include "scenario/resolved/resolved.hpp"
#include "scenario/resolve/stream_builder.hpp"

namespace takt::scenario {

/// Of applications whose threads are resolved. Fills resolved.dds and the threads' participants.
void resolve_dds(Resolved& resolved, StreamBuilder& builder, json::Diagnostics& diagnostics);

}  // namespace takt::scenario
