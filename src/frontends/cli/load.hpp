// SPDX-License-Identifier: Apache-2.0
// What commands have in common that take a scenario: the scenario and the options that change it.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "cli/command_line.hpp"
#include "scenario/resolve.hpp"

namespace takt::cli {

struct ScenarioOptions {
  std::string file;
  std::optional<std::string> seed;
  std::optional<std::string> duration;
  std::vector<std::string> overrides;
  std::string format = "text";
  bool is_json() const { return format == "json"; }
};

/// Adds SCENARIO, --seed, --duration, --set and --format.
void add_scenario_options(Command command, ScenarioOptions& options);
/// The same without SCENARIO.
void add_scenario_changes(Command command, ScenarioOptions& options);

/// A warning on standard error if files.json beside the file says that a takt with another number of behaviour wrote
/// it.
void warn_of_another_maker(const std::string& file);

/// Loads the scenario. Diagnostics go to standard error as text, or to standard output as JSON with --format json. Null
/// if there was an error; the exit status is then bad_input.
std::unique_ptr<scenario::Resolved> load(const ScenarioOptions& options, bool is_quiet = false);
/// The same, and says nothing: the diagnostics are the caller's.
std::unique_ptr<scenario::Resolved> load(const ScenarioOptions& options, json::Diagnostics& diagnostics);

}  // namespace takt::cli
