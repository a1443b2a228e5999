// SPDX-License-Identifier: Apache-2.0
// takt emulate: a scenario on real nodes in network namespaces of this machine, compared with its simulated run.
#include <cstdio>
#include <memory>
#include <string>

#include "cli/commands.hpp"
#include "cli/companion.hpp"
#include "cli/interrupt.hpp"
#include "cli/load.hpp"
#include "cli/places.hpp"
#include "emulate/emulation.hpp"

namespace takt::cli {
namespace {

ExitStatus run_emulation(const ScenarioOptions& options, const std::string& keep, int patience) {
  if (!can_write({{"--keep", keep, Place::Kind::folder}}, options.is_json())) return ExitStatus::bad_input;
  const auto resolved = load(options, true);
  if (!resolved) return ExitStatus::bad_input;
  const emulate::Plan plan = emulate::plan_of(*resolved);
  for (const std::string& refusal : plan.refusals)
    std::fprintf(stderr, "takt: cannot emulate %s: %s\n", resolved->scenario.name.c_str(), refusal.c_str());
  if (!plan.refusals.empty()) return ExitStatus::bad_input;
  const InterruptGuard interrupt;
  emulate::Settings settings;
  settings.keep = keep;
  settings.patience_ns = std::int64_t{patience} * 1'000'000'000;
  settings.stop_requested = [](const void* guard) { return static_cast<const InterruptGuard*>(guard)->requested(); };
  settings.context = &interrupt;
  emulate::Result result;
  std::string problem;
  const bool done = emulate::emulate(*resolved, plan, settings, result, problem);
  if (!done && !result.interrupted) {
    std::fprintf(stderr, "takt: cannot emulate %s here: %s\n", resolved->scenario.name.c_str(), problem.c_str());
    return ExitStatus::internal_error;
  }
  std::fputs((options.is_json() ? emulate::to_json({resolved->scenario.name, result})
                                : to_text(result, resolved->scenario.name))
                 .c_str(),
             stdout);
  if (result.interrupted) return ExitStatus::interrupted;
  return result.is_same() ? ExitStatus::pass : ExitStatus::requirement_failed;
}

}  // namespace

void add_emulate_command(Command app, ExitStatus& status) {
  const Command command = app.add_subcommand("emulate", companion_help("emulate"));
  const auto options = std::make_shared<ScenarioOptions>();
  const auto keep = std::make_shared<std::string>();
  const auto patience = std::make_shared<int>(10);
  add_scenario_options(command, *options);
  command.add_option("--keep", *keep, "Keep the files and logs of the nodes in this folder").type_name("FOLDER");
  command
      .add_option("--patience", *patience,
                  "Seconds for nodes to come where the simulated run was, before the script goes on without them")
      .between(0, 3600);
  command.footer(
      "Examples:\n"
      "  sudo takt emulate scenarios/three-slaves-star.json\n"
      "  sudo takt emulate scenarios/three-slaves-star.json --set programs.0.receive_timeout=1s     on a busy machine\n"
      "  sudo takt emulate scenarios/applications/gateway.json --duration 10s                       threads, topics "
      "and a gateway\n"
      "Needs root. It lasts as long as the scenario does, longer where the machine is slow. Gates, shapers, streams, "
      "clocks and chance are left out and named.\n"
      "Exit status: 0 the same order of transitions, 1 another one, 2 bad input or nothing that can be emulated, 3 the "
      "machine\n"
      "does not permit it, 130 interrupted. Whatever happens, namespaces and nodes are removed.");
  command.callback([options, keep, patience, &status] { status = run_emulation(*options, *keep, *patience); });
}

}  // namespace takt::cli
