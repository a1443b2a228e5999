// SPDX-License-Identifier: Apache-2.0
#include "cli/load.hpp"

#include <cstdio>

#include "cli/input_kind.hpp"
#include "cli/terminal.hpp"
#include "output/written_files.hpp"

namespace takt::cli {

void warn_of_another_maker(const std::string& file) {
  if (const std::string difference = output::made_by_another(file); !difference.empty())
    std::fprintf(stderr, "takt: warning: %s: what it showed then need not happen now\n", difference.c_str());
}

void add_scenario_options(Command command, ScenarioOptions& options) {
  command.add_option("SCENARIO", options.file, "The scenario file (JSON, comments allowed)").required();
  add_scenario_changes(command, options);
}

void add_scenario_changes(Command command, ScenarioOptions& options) {
  command.add_option("--seed", options.seed, "The seed").type_name("N").default_text("the scenario's");
  command.add_option("--duration", options.duration, "The duration, such as 100ms or 1h")
      .type_name("D")
      .default_text("the scenario's");
  command
      .add_option("--set", options.overrides,
                  "Another value in the scenario: network.links.0.rate=100Mbps (repeatable)")
      .type_name("POINTER=VALUE")
      .one_value_each();
  command.add_option("--format", options.format, "text or json").one_of({"text", "json"}).type_name("FORMAT");
}

std::unique_ptr<scenario::Resolved> load(const ScenarioOptions& options, json::Diagnostics& diagnostics) {
  std::vector<std::string> overrides = options.overrides;
  if (options.seed) overrides.push_back("/seed=" + *options.seed);
  if (options.duration) overrides.push_back("/duration=" + *options.duration);
  auto resolved = scenario::load_file(options.file, overrides, diagnostics);
  if (!resolved)
    if (json::Diagnostics other; belongs_elsewhere(options.file, InputKind::scenario, other)) diagnostics = other;
  return resolved;
}

std::unique_ptr<scenario::Resolved> load(const ScenarioOptions& options, bool is_quiet) {
  json::Diagnostics diagnostics;
  auto resolved = load(options, diagnostics);
  if (!resolved && options.is_json()) {
    std::fputs(json::pretty(diagnostics.to_json()).c_str(), stdout);
    return nullptr;
  }
  if (!resolved || !is_quiet) tell(diagnostics);
  warn_of_another_maker(options.file);
  return resolved;
}

}  // namespace takt::cli
