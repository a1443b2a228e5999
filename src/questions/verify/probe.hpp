// SPDX-License-Identifier: Apache-2.0
// One run of a choice, and what it says of each requirement.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "results/run_result.hpp"
#include "scenario/description/description.hpp"
#include "verify/found_run.hpp"
#include "verify/monitor.hpp"

namespace takt::verify {

/// A run that has come to its end.
struct Probe {
  std::vector<results::RequirementResult> requirements;  ///< in the order of RunResult::requirements
  std::uint64_t events = 0;
  std::uint64_t digest = 0;
  std::vector<Violation> violations;  ///< of assumptions
  std::string contradiction;          ///< of a bound; empty if there is none
  std::vector<std::uint64_t>
      broken;  ///< by requirement: of a Program's invariants, how often they were violated; else 0
  std::string
      reactions;  ///< all reactions of Programs but for their times: runs that differ in nothing else have the same
};

/// Runs a scenario and watches it; `bounds` hold for every choice. Nothing if it cannot be resolved (a choice never
/// makes it so), or if `interrupted` said so in between.
std::optional<Probe> probe(const scenario::Scenario& scenario, const analysis::Bounds& bounds,
                           const std::function<bool()>& interrupted);

/// Runs all of them on so many threads; the same results, in the same order, for any number.
std::vector<std::optional<Probe>> probe_all(std::span<const FoundRun> runs, const analysis::Bounds& bounds,
                                            unsigned jobs, const std::function<bool()>& interrupted);

}  // namespace takt::verify
