// SPDX-License-Identifier: Apache-2.0
// One scenario of a call after the other: pages, JSON, test cases and the exit status of all of them.
#pragma once

#include <functional>
#include <optional>
#include <string>

#include "cli/batch.hpp"
#include "cli/exit_status.hpp"
#include "report/junit.hpp"

namespace takt::cli {

/// What a run or a verification of one scenario leaves for its call.
struct ScenarioDone {
  ExitStatus status = ExitStatus::internal_error;
  std::string page = {};
  std::string told = {};                         ///< on standard error, behind the page
  std::string report = {};                       ///< a page with pictures outside of the folder
  std::optional<report::JunitSuite> suite = {};  ///< none: it has failed before its end, which was said
};

/// Does all scenarios of the call, prints their pages and writes the file of --junit. Once one was interrupted or has
/// failed, no further one is done; those that Ctrl-C has kept out are undecided in the file.
ExitStatus run_batch(const BatchOptions& options, const std::string& command,
                     const std::function<ScenarioDone(const LoadedScenario&)>& act);

/// Says on standard error what cannot be written; the status of that.
ExitStatus cannot_write(const std::string& problem);

}  // namespace takt::cli
