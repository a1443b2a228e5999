// SPDX-License-Identifier: Apache-2.0
// What the page draws and links: the network, the paths of streams in it, and where requirements stand.
#pragma once

#include <string>

#include "results/run_result.hpp"
#include "scenario/resolved/resolved.hpp"

namespace takt::studio {

/// JSON: {"nodes": [{"name", "kind", "title", "failed", "x", "y"}], "links": [{"a", "b", "colour", "title", "failed"}],
/// "legend": [{"colour", "text"}], "hidden", "paths": {stream: [[node, ...], ...]} (positions in "nodes"; one for each
/// listener or member), "requirements": [{"entry", "subject"}]}. The last by position in the result: the item of
/// "require", or null, and the stream, Program or node that is meant. Without a result loads are averages, and there
/// are none.
std::string plant_json(const scenario::Resolved& resolved, const results::RunResult* result);

}  // namespace takt::studio
