// SPDX-License-Identifier: Apache-2.0
// Topics, applications and gateways: who publishes what to whom, over which streams, and how threads are checked.
#pragma once

#include "scenario/resolved/resolved.hpp"
#include "scenario/resolve/stream_builder.hpp"

namespace takt::scenario {

/// Fills topics, applications and signals and adds their streams. `publishers` counts the PublisherIds that are taken.
void resolve_applications(Resolved& resolved, StreamBuilder& builder, std::size_t& publishers,
                          json::Diagnostics& diagnostics);

}  // namespace takt::scenario
