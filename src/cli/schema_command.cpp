// takt schema: the JSON Schema of scenario files, for editors.
#include <CLI/CLI.hpp>
#include <cstdio>
#include <memory>

#include "cli/commands.hpp"
#include "scenario/description/description.hpp"
#include "study/description.hpp"

namespace takt::cli {

void add_schema_command(CLI::App& app, ExitStatus& status) {
  CLI::App& command = *app.add_subcommand("schema", "Print the JSON Schema of scenario files");
  const auto of_studies = std::make_shared<bool>(false);
  command.add_flag("--study", *of_studies, "The schema of study files instead");
  command.footer("Examples:\n  takt schema > scenarios/takt.schema.json\n  takt schema --study > scenarios/studies/takt-study.schema.json");
  command.callback([of_studies, &status] {
    const std::string schema = *of_studies ? scenario::json::schema<study::Study>("takt study") : scenario::json::schema<scenario::Scenario>("takt scenario");
    std::fputs(schema.c_str(), stdout);
    status = ExitStatus::pass;
  });
}

}  // namespace takt::cli
