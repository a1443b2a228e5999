// SPDX-License-Identifier: Apache-2.0
// takt bound: how late a frame can come and how long a reaction can take, whatever the phases.
#include <cstdio>
#include <memory>

#include "analysis/bounds.hpp"
#include "analysis/report.hpp"
#include "analysis/server_network_file.hpp"
#include "cli/commands.hpp"
#include "cli/load.hpp"
#include "cli/terminal.hpp"
#include "json/quantity.hpp"

namespace takt::cli {
namespace {

ExitStatus report_mistakes(const json::Diagnostics& diagnostics, bool as_json) {
  if (as_json)
    std::fputs(json::pretty(diagnostics.to_json()).c_str(), stdout);
  else
    tell(diagnostics);
  return ExitStatus::bad_input;
}

/// A file of servers and flows instead of a scenario. Nothing if it is none.
std::optional<ExitStatus> bound_server_network(const ScenarioOptions& options) {
  json::Diagnostics diagnostics;
  const auto document = json::parse_file(options.file, diagnostics);
  if (!document || !analysis::is_server_network(*document)) return std::nullopt;
  if (options.seed || options.duration || !options.overrides.empty())
    diagnostics.error({options.file, 0, 0, ""}, "an option for scenarios",
                      {"--seed, --duration or --set with a network of servers", "none of them"});
  const auto file = analysis::read_server_network(*document, diagnostics);
  if (!file || diagnostics.has_errors()) return report_mistakes(diagnostics, options.is_json());
  try {
    std::fputs(analysis::server_network_report(*file, options.is_json()).c_str(), stdout);
  } catch (const analysis::RationalOverflow& overflow) {
    diagnostics.error({options.file, 0, 0, ""}, "numbers too long for exact results",
                      {overflow.what(), "shorter numbers, or fewer of them"});
    return report_mistakes(diagnostics, options.is_json());
  }
  return ExitStatus::pass;
}

bool read_duration(const std::string& text, sim::Duration& value, bool as_json) {
  const auto parsed = json::parse_duration(text);
  if (parsed) {
    value = *parsed;
    return true;
  }
  json::Diagnostics diagnostics;
  diagnostics.error({"--clock-error", 0, 0, ""}, "not a duration", {json::quote(text), "a duration such as \"500ns\""});
  report_mistakes(diagnostics, as_json);
  return false;
}

}  // namespace

void add_bound_command(Command app, ExitStatus& status) {
  const Command command = app.add_subcommand("bound", "Bound latencies, backlogs and reactions by analysis");
  const auto options = std::make_shared<ScenarioOptions>();
  add_scenario_options(command, *options);
  const auto clock_error = std::make_shared<std::string>("1us");
  command
      .add_option("--clock-error", *clock_error,
                  "How far each synchronised clock is at most from the time that all nodes on a way share, so that two "
                  "differ by twice that, where no requirement \"sync\" or \"clocks\" says it")
      .type_name("D");
  command.footer(
      "Examples:\n"
      "  takt bound scenarios/robot-arm.json                 bounds by stream, hop and reaction, and what they rest "
      "on\n"
      "  takt bound scenarios/robot-arm.json --format json   the same for programs\n"
      "  takt bound network.json                             a network of servers and flows (docs/bounds.md): exact "
      "TFA and SFA\n"
      "Exit status: 0, also where something is unbounded; 2 mistakes (all of them are listed).");
  command.callback([options, clock_error, &status] {
    analysis::BoundOptions how;
    if (!read_duration(*clock_error, how.clock_error, options->is_json())) {
      status = ExitStatus::bad_input;
      return;
    }
    if (const auto done = bound_server_network(*options)) {
      status = *done;
      return;
    }
    const auto resolved = load(*options);
    if (!resolved) {
      status = ExitStatus::bad_input;
      return;
    }
    const analysis::Bounds bounds = analysis::bound(*resolved, how);
    print(options->is_json() ? analysis::json_report(*resolved, bounds) : analysis::text_report(*resolved, bounds));
    status = ExitStatus::pass;
  });
}

}  // namespace takt::cli
