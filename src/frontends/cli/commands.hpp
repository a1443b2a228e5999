// SPDX-License-Identifier: Apache-2.0
// The sub-commands: each adds itself to the command line and runs when it was chosen.
#pragma once

#include "cli/command_line.hpp"
#include "cli/exit_status.hpp"

namespace takt::cli {

/// Each adds its sub-command to `app` and sets `status` when it has run.
void add_run_command(Command app, ExitStatus& status);
void add_check_command(Command app, ExitStatus& status);
void add_schema_command(Command app, ExitStatus& status);
/// Of the kinds of files that only companions read or write.
void add_companion_schema_command(Command app, ExitStatus& status);
void add_program_command(Command app, ExitStatus& status);
void add_node_command(Command app, ExitStatus& status);
void add_ctl_command(Command app, ExitStatus& status);
void add_emulate_command(Command app, ExitStatus& status);
void add_explore_command(Command app, ExitStatus& status);
void add_bound_command(Command app, ExitStatus& status);
void add_explain_command(Command app, ExitStatus& status);
void add_verify_command(Command app, ExitStatus& status);
void add_study_command(Command app, ExitStatus& status);
void add_compare_command(Command app, ExitStatus& status);
void add_paper_command(Command app, ExitStatus& status);
void add_schedule_command(Command app, ExitStatus& status);
void add_export_command(Command app, ExitStatus& status);
void add_import_command(Command app, ExitStatus& status);
void add_studio_command(Command app, ExitStatus& status);

}  // namespace takt::cli
