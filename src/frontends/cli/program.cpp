// SPDX-License-Identifier: Apache-2.0
#include "cli/program.hpp"

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <exception>
#include <new>
#include <span>

#include "cli/companion.hpp"
#include "results/version.hpp"
#include "sim/check.hpp"

namespace takt::cli {

int run_program(int argc, char** argv, const std::string& version, std::initializer_list<AddCommand> commands,
                bool is_core) {
  try {
    if (is_core && argc > 1)
      if (const Companion* const companion = find_companion(argv[1]))
        return static_cast<int>(become(companion->program, {argv, argv + argc}));
    const ExitStatus status = run_command_line(
        argc, argv, "takt: simulates TSN networks whose nodes run distributed OPC UA Programs", version,
        "Examples:\n"
        "  takt run scenarios/robot-arm.json      simulate and judge a scenario\n"
        "  takt check scenarios/robot-arm.json    what the scenario resolves to\n"
        "  takt run --help                        all options of a sub-command",
        [&](Command app, ExitStatus& result) {
          for (const AddCommand add : commands) add(app, result);
        },
        is_core ? std::span<const Companion>(companions) : std::span<const Companion>());
    if (std::fflush(stdout) == 0 && std::ferror(stdout) == 0) return static_cast<int>(status);
    std::fprintf(stderr, "takt: cannot write to standard output: %s\n", std::strerror(errno));
  } catch (const sim::InvariantBroken& broken) {
    std::fprintf(stderr, "takt: internal error, please report it with the scenario:\n%s\n", broken.what());
  } catch (const std::bad_alloc&) {
    std::fprintf(stderr, "takt: out of memory\n");
  } catch (const std::exception& error) {
    std::fprintf(stderr, "takt: internal error: %s\n", error.what());
  }
  return static_cast<int>(ExitStatus::internal_error);
}

int run_companion(int argc, char** argv, std::initializer_list<AddCommand> commands) {
  if (is_of_another_takt()) {
    std::fprintf(stderr,
                 "takt %s: this program is from another build than the takt that started it, and behaves otherwise: "
                 "build or install both\n",
                 argc > 1 ? argv[1] : "");
    return static_cast<int>(ExitStatus::bad_input);
  }
  return run_program(argc, argv, std::string("takt ") + results::version, commands);
}

}  // namespace takt::cli
