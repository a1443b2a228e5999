// SPDX-License-Identifier: Apache-2.0
// What the main functions of takt and of its companions share.
#pragma once

#include <initializer_list>
#include <string>

#include "cli/commands.hpp"

namespace takt::cli {

using AddCommand = void (*)(Command app, ExitStatus& status);

/// Runs the sub-command that the command line names; returns the exit status of the process. An exception that nobody
/// has caught is printed here. `is_core`: sub-commands that only companions have are known, too.
int run_program(int argc, char** argv, const std::string& version, std::initializer_list<AddCommand> commands,
                bool is_core = false);

/// The main function of a companion.
int run_companion(int argc, char** argv, std::initializer_list<AddCommand> commands);

}  // namespace takt::cli
