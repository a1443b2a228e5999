// takt paper coexistence --real: criteria 1 and 2 on this machine.
#pragma once

#include <string>

#include "cli/exit_status.hpp"

namespace takt::cli {

struct RealCoexistenceOptions {
  bool is_real = false;   ///< without it the paper is simulated
  bool is_short = false;
  bool is_quiet = false;
  bool is_json = false;
  std::string out;   ///< folder; "": nothing is written
};

ExitStatus run_real_coexistence(const RealCoexistenceOptions& options);

}  // namespace takt::cli
