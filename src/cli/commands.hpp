// The sub-commands: each adds itself to the command line and runs when it was chosen.
#pragma once

#include "cli/exit_status.hpp"

namespace CLI {
class App;
}

namespace takt::cli {

/// Each adds its sub-command to `app` and sets `status` when it has run.
void add_run_command(CLI::App& app, ExitStatus& status);
void add_check_command(CLI::App& app, ExitStatus& status);
void add_schema_command(CLI::App& app, ExitStatus& status);
void add_program_command(CLI::App& app, ExitStatus& status);
void add_node_command(CLI::App& app, ExitStatus& status);
void add_ctl_command(CLI::App& app, ExitStatus& status);
void add_emulate_command(CLI::App& app, ExitStatus& status);
void add_explore_command(CLI::App& app, ExitStatus& status);
void add_bound_command(CLI::App& app, ExitStatus& status);
void add_verify_command(CLI::App& app, ExitStatus& status);
void add_study_command(CLI::App& app, ExitStatus& status);
void add_compare_command(CLI::App& app, ExitStatus& status);
void add_paper_command(CLI::App& app, ExitStatus& status);

}  // namespace takt::cli
