// SPDX-License-Identifier: Apache-2.0
// A run's result as JSON: what --format json prints and result.json holds.
#pragma once

#include <string>

#include "json/node.hpp"
#include "results/run_result.hpp"

namespace takt::results {

/// Keys and meaning: docs/reference/result.md. All times are whole picoseconds in keys that end with _ps.
std::string run_json(const RunResult& result);
/// The same before it is text.
json::Node run_node(const RunResult& result);

}  // namespace takt::results
