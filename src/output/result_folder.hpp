// The folder that --out names: each file is written whole or not at all.
#pragma once

#include <string>

#include "output/written_files.hpp"
#include "results/run_result.hpp"

namespace takt::output {

/// Writes scenario.json (the resolved copy), streams.csv, reactions.csv, ports.csv, queues.csv, histograms.csv and, when older files are gone, result.json into the
/// folder, which is made if it is not there. Returns an empty text, or what went wrong and where.
std::string write_result_folder(WrittenFiles& folder, const results::RunResult& result, const std::string& resolved_scenario);

/// Makes a folder, if it is not there, and tries whether files can be written there: before a long run, not after it. Returns an empty text, or what went wrong.
std::string prepare_folder(const std::string& folder);

/// The same for one file, whose folder is made.
std::string prepare_file(const std::string& path);

/// Writes one file whole: to a temporary name beside it, then renamed. Returns an empty text, or what went wrong.
std::string write_file(const std::string& path, const std::string& content);

}  // namespace takt::output
