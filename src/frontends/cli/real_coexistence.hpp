// SPDX-License-Identifier: Apache-2.0
// takt paper coexistence --real: criteria 1 and 2 on this machine.
#pragma once

#include <optional>
#include <string>

#include "cli/exit_status.hpp"
#include "emulate/coexistence.hpp"
#include "papers/coexistence/measured.hpp"

namespace takt::cli {

struct RealCoexistenceOptions {
  bool is_short = false;
  bool is_quiet = false;
  std::string out;  ///< folder; "": nothing is written
};

/// Measures, and writes measured.txt and measured.json into the folder. Nothing if it could not: `failure` is the exit
/// status then, and what went wrong is told.
std::optional<emulate::MeasuredCoexistence> measure_coexistence(const RealCoexistenceOptions& options,
                                                                ExitStatus& failure);

/// What of it stands in the paper's tables.
papers::coexistence::MeasuredCriteria criteria_of(const emulate::MeasuredCoexistence& measured);

}  // namespace takt::cli
