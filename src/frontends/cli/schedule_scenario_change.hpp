// SPDX-License-Identifier: Apache-2.0
// takt schedule --to SCENARIO: a scheduled scenario that runs, what shall change, and the way there.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "cli/exit_status.hpp"
#include "json/diagnostics.hpp"
#include "sim/time.hpp"

namespace takt::cli {

struct ScenarioChangeOptions {
  std::string running;                ///< file of the scheduled scenario
  std::optional<std::string> wanted;  ///< file of the scenario that it was made of
  std::optional<std::string> add;     ///< file of streams
  std::vector<std::string> remove;    ///< names of streams
  std::vector<std::string> fail;      ///< links and nodes
  std::optional<std::string> at;
  std::optional<std::string> lead;
  std::uint32_t entries = 0;
  std::optional<std::string> out;         ///< where the plant afterwards goes
  std::optional<std::string> plant;       ///< where it goes with automatic gates
  std::optional<std::string> transition;  ///< where the scenario of the transition goes
  bool is_json = false;
};

/// Reports to standard output; mistakes as those of other commands.
ExitStatus change_scheduled_scenario(const ScenarioChangeOptions& options);

}  // namespace takt::cli
