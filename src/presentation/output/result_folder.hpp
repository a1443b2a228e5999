// SPDX-License-Identifier: Apache-2.0
// The folder that --out names: each file is written whole or not at all.
#pragma once

#include <array>
#include <string>
#include <string_view>

#include "output/written_files.hpp"
#include "results/run_result.hpp"

namespace takt::output {

/// What write_result_folder() writes, and the list of what was written.
inline constexpr std::array<std::string_view, 8> result_files{"scenario.json", "streams.csv", "reactions.csv",
                                                              "ports.csv",     "queues.csv",  "histograms.csv",
                                                              "result.json",   "files.json"};

/// Writes scenario.json (the resolved copy), streams.csv, reactions.csv, ports.csv, queues.csv, histograms.csv and,
/// when older files are gone, result.json into the folder, which is made if it is not there. Returns an empty text, or
/// what went wrong and where.
std::string write_result_folder(WrittenFiles& folder, const results::RunResult& result,
                                const std::string& resolved_scenario);

/// Writes one file whole: to a temporary name beside it, then renamed; its folder is made if it is not there. A device
/// or a pipe is written to as it is. Returns an empty text, or what went wrong.
std::string write_file(const std::string& path, const std::string& content);

}  // namespace takt::output
