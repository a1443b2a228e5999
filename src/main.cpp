#include <cerrno>
#include <cstdio>
#include <cstring>
#include <exception>
#include <new>
#include <string>

#include "cli/commands.hpp"
#include "cli/revision.hpp"
#include "results/version.hpp"
#include "sim/check.hpp"

namespace {

using takt::cli::ExitStatus;

void add_commands(takt::cli::Command app, ExitStatus& status) {
  takt::cli::add_run_command(app, status);
  takt::cli::add_check_command(app, status);
  takt::cli::add_schema_command(app, status);
  takt::cli::add_program_command(app, status);
  takt::cli::add_node_command(app, status);
  takt::cli::add_ctl_command(app, status);
  takt::cli::add_emulate_command(app, status);
  takt::cli::add_explore_command(app, status);
  takt::cli::add_bound_command(app, status);
  takt::cli::add_verify_command(app, status);
  takt::cli::add_explain_command(app, status);
  takt::cli::add_study_command(app, status);
  takt::cli::add_compare_command(app, status);
  takt::cli::add_paper_command(app, status);
  takt::cli::add_schedule_command(app, status);
  takt::cli::add_export_command(app, status);
  takt::cli::add_import_command(app, status);
  takt::cli::add_studio_command(app, status);
}

/// "takt 0.1.0, revision 26f987b12345", and what this build has and has not.
std::string version_text() {
  std::string text = std::string("takt ") + takt::results::version;
  if (*takt::cli::revision != '\0') text += std::string(", revision ") + takt::cli::revision;
  return text + (*takt::cli::features == '\0' ? "" : "\n") + takt::cli::features;
}

ExitStatus main_with(int argc, char** argv) {
  return takt::cli::run_command_line(argc, argv, "takt: simulates TSN networks whose nodes run distributed OPC UA Programs",
                                     version_text(),
                                     "Examples:\n"
                                     "  takt run scenarios/robot-arm.json      simulate and judge a scenario\n"
                                     "  takt check scenarios/robot-arm.json    what the scenario resolves to\n"
                                     "  takt run --help                        all options of a sub-command",
                                     add_commands);
}

}  // namespace

int main(int argc, char** argv) {
  try {
    const ExitStatus status = main_with(argc, argv);
    if (std::fflush(stdout) == 0 && std::ferror(stdout) == 0) return static_cast<int>(status);
    std::fprintf(stderr, "takt: cannot write to standard output: %s\n", std::strerror(errno));
  } catch (const takt::sim::InvariantBroken& broken) {
    std::fprintf(stderr, "takt: internal error, please report it with the scenario:\n%s\n", broken.what());
  } catch (const std::bad_alloc&) {
    std::fprintf(stderr, "takt: out of memory\n");
  } catch (const std::exception& error) {
    std::fprintf(stderr, "takt: internal error: %s\n", error.what());
  }
  return static_cast<int>(ExitStatus::internal_error);
}
