// SPDX-License-Identifier: Apache-2.0
// CSV traces of traffic: one frame a line, its time and its payload.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "json/diagnostics.hpp"
#include "models/host/talker.hpp"

namespace takt::scenario {

/// Reads lines `time,payload` such as `12.5us,100B`; a first line `time,payload` and empty lines are skipped. Times
/// ascend. All mistakes are reported with their line; what could be read is returned.
std::vector<models::TraceSchedule::Entry> parse_trace(std::string_view text, const std::string& file,
                                                      json::Diagnostics& diagnostics);

/// The same from a file. `place` is where the scenario names it. A relative name counts from the folder of the
/// scenario.
std::vector<models::TraceSchedule::Entry> read_trace(const std::string& name, const json::Place& place,
                                                     json::Diagnostics& diagnostics);

}  // namespace takt::scenario
