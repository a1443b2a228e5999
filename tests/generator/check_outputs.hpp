// SPDX-License-Identifier: Apache-2.0
// What takt writes of a scenario, read back: whatever the names, files keep their form.
#pragma once

#include <string>

#include "results/run_result.hpp"
#include "scenario/resolved/resolved.hpp"

namespace takt::generator {

/// The first mistake, or an empty text. Of a run: the report, result.json, tables, the time line, waveforms and the
/// page; and all exports. JSON, XML, CSV and scripts are read back, names in them are those of the scenario, and HTML
/// in names does not come out as such.
std::string mistake_in_outputs(const scenario::Resolved& resolved, const results::RunResult& result);

}  // namespace takt::generator
