// SPDX-License-Identifier: Apache-2.0
// takt: what a first run needs. The other sub-commands are programs beside it (cli/companion.hpp).
#include "cli/program.hpp"
#include "cli/revision.hpp"
#include "results/behaviour.hpp"
#include "results/version.hpp"

namespace {

/// "takt 0.2.0, behaviour 3, revision 26f987b12345", and what this build has and has not.
std::string version_text() {
  std::string text =
      std::string("takt ") + takt::results::version + ", behaviour " + std::to_string(takt::results::behaviour());
  if (*takt::cli::revision != '\0') text += std::string(", revision ") + takt::cli::revision;
  return text + (*takt::cli::features == '\0' ? "" : "\n") + takt::cli::features;
}

}  // namespace

int main(int argc, char** argv) {
  using namespace takt::cli;
  return run_program(argc, argv, version_text(),
                     {add_run_command, add_check_command, add_bound_command, add_verify_command, add_explain_command,
                      add_explore_command, add_schema_command, add_program_command},
                     true);
}
