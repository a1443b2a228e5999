// SPDX-License-Identifier: Apache-2.0
// takt schedule --to: a schedule that runs, and what shall change.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "cli/exit_status.hpp"
#include "schedule/problem.hpp"

namespace takt::cli {

struct ChangeOptions {
  std::string schedule;             ///< file of the solution
  std::optional<std::string> add;   ///< file of streams
  std::vector<std::string> remove;  ///< names of streams
  std::vector<std::string> fail;    ///< names of links
  std::optional<std::string> out;
  std::optional<std::string> plant;  ///< where the instance goes as it is then
  bool is_json = false;
};

/// Reports to standard output; mistakes as those of other commands.
ExitStatus change_schedule(schedule::Problem problem, const ChangeOptions& options);

}  // namespace takt::cli
