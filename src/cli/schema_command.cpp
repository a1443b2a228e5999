// takt schema: the JSON Schema of scenario files, for editors.
#include <CLI/CLI.hpp>
#include <cstdio>

#include "cli/commands.hpp"
#include "scenario/description.hpp"

namespace takt::cli {

void add_schema_command(CLI::App& app, ExitStatus& status) {
  CLI::App& command = *app.add_subcommand("schema", "Print the JSON Schema of scenario files");
  command.footer("Example:\n  takt schema > scenarios/takt.schema.json");
  command.callback([&status] {
    std::fputs(scenario::json::schema<scenario::Scenario>("takt scenario").c_str(), stdout);
    status = ExitStatus::pass;
  });
}

}  // namespace takt::cli
