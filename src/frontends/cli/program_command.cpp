// SPDX-License-Identifier: Apache-2.0
// takt program: the state machine of OPC UA Programs, from the table that the code runs on.
#include <cstdio>
#include <memory>

#include "cli/commands.hpp"
#include "cli/terminal.hpp"
#include "program/documentation.hpp"

namespace takt::cli {

void add_program_command(Command app, ExitStatus& status) {
  const Command command = app.add_subcommand("program", "Print the state machine of OPC UA Programs");
  const auto is_table = std::make_shared<bool>(false);
  const auto is_dot = std::make_shared<bool>(false);
  const Option table =
      command.add_flag("--table", *is_table, "States, transitions and methods as text (if nothing else is asked)");
  command.add_flag("--dot", *is_dot, "The same as a graph for Graphviz").excludes(table);
  command.footer(
      "Examples:\n"
      "  takt program --table\n"
      "  takt program --dot | dot -Tsvg > program.svg");
  command.callback([is_table, is_dot, &status] {
    if (*is_dot)
      std::fputs(program::table_dot().c_str(), stdout);
    else
      print(program::table_text());
    status = ExitStatus::pass;
  });
}

}  // namespace takt::cli
