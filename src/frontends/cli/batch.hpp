// SPDX-License-Identifier: Apache-2.0
// What run and verify have in common: several scenarios a call, which of their requirements are asked for, and where
// the verdicts go.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "cli/load.hpp"

namespace takt::cli {

struct BatchOptions {
  ScenarioOptions scenario;  ///< of each; its file is that of one after the other
  std::vector<std::string> files;
  std::vector<std::string> only;  ///< names or spellings of requirements; all without any
  std::string out;
  std::string report;
  std::string junit;
  bool quiet = false;
  bool is_single() const { return files.size() == 1; }
};

/// Adds SCENARIO..., --seed, --duration, --set, --format, --only and --junit.
void add_batch_options(Command command, BatchOptions& options);

/// A scenario of the call that is sound.
struct LoadedScenario {
  std::string file;
  std::string out;  ///< its folder: that of --out, or one within it where there are several scenarios
  std::unique_ptr<scenario::Resolved> resolved;
  std::vector<bool> asked;  ///< by line of a report: whether the requirement is asked for
};

/// All scenarios of the call, or nothing after diagnostics of all of them: then nothing is run or written. Those of
/// which --only names no requirement are left out, which is said.
std::optional<std::vector<LoadedScenario>> load_all(const BatchOptions& options);

/// Whether the word means a requirement: by its name or spelling, in which * stands for any text.
bool is_meant(std::string_view word, std::string_view name, std::string_view text);

/// JSON of several scenarios is one array.
std::string joined_json(const std::vector<std::string>& pages, bool is_single);

}  // namespace takt::cli
