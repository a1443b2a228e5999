// A run's result as JSON: what --format json prints and result.json holds.
#pragma once

#include <string>

#include "results/run_result.hpp"

namespace takt::output {

/// Keys and meaning: docs/results.md. All times are whole picoseconds in keys that end with _ps.
std::string run_json(const results::RunResult& result);

}  // namespace takt::output
