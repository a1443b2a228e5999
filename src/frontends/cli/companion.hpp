// SPDX-License-Identifier: Apache-2.0
// Programs beside takt. The program `takt` has what a first run needs; each other sub-command is in a companion, as git
// and cargo do it.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "cli/exit_status.hpp"

namespace takt::cli {

struct Companion {
  std::string_view command;
  std::string_view program;
  const char* help;  ///< as `takt --help` prints it
  const char* missing =
      "tools/run builds it after its first result; cmake --build builds it, too";  ///< what helps if it is not there
};

/// Every sub-command that is not in `takt` itself.
inline constexpr Companion companions[] = {
    {"schedule", "takt-schedule", "Find routes, phases and gate lists, or say why there are none"},
    {"study", "takt-study", "What if: run the variants of a scenario, keep the figures, report"},
    {"compare", "takt-study", "Is scenario B better than A, by how much, and where do they part?"},
    {"export", "takt-exchange",
     "Write a scenario for devices and other tools: scripts of Linux, YANG, INET and the like"},
    {"import", "takt-exchange", "Make a scenario of what devices are set to and other tools write"},
    {"node", "takt-node", "Run a participant of Programs, or applications and gateways, on this machine"},
    {"ctl", "takt-node", "Call a method of a running node, or ask for its status"},
    {"emulate", "takt-emulate",
     "Run a scenario on real nodes in network namespaces and compare it with the simulated run"},
    {"paper", "takt-paper", "Reproduce a published evaluation"},
    {"studio", "takt-studio", "Edit a scenario in a browser, with verdicts, bounds and network beside it",
     "tools/studio installs what it takes (npm, cpp-httplib), builds and opens it"},
};

/// The help of a companion's sub-command. CHECK: there is such a command.
const char* companion_help(std::string_view command);

/// The companion that has this sub-command; null: none.
const Companion* find_companion(std::string_view command);

/// Where takt or a companion is: in the folder of the running program, or, installed, in bin and libexec/takt. Empty:
/// nowhere.
std::string path_of_program(std::string_view program);

/// Replaces this process by `program` with these words: the name of the command line, the sub-command, its arguments.
/// Returns only if that cannot be; the reason has been printed then.
ExitStatus become(std::string_view program, std::vector<std::string> words);

/// Of a companion: takt has started it, and its number of behaviour is not that of this program. So one of both is from
/// another build.
bool is_of_another_takt();

/// What `program` prints for these words; none if it is not there or fails.
std::optional<std::string> output_of(std::string_view program, std::vector<std::string> words);

}  // namespace takt::cli
