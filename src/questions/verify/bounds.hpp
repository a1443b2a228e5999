// SPDX-License-Identifier: Apache-2.0
// What is proved about each requirement, before anything is run: bounds of times and counts, invariants by exploration.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "analysis/bounds.hpp"
#include "results/run_result.hpp"
#include "scenario/resolved/resolved.hpp"

namespace takt::verify {

/// What no run that the scenario allows exceeds, as long as what it rests on holds.
struct Proof {
  std::optional<sim::Duration> time;  ///< of requirements about times
  bool holds = false;                 ///< the requirement is always met
  bool is_reported_only =
      false;  ///< invariants whose violations the scenario only reports: nothing is proved, and nothing fails
  bool is_given = false;              ///< a promise of a data sheet: nothing is proved
  std::string reason;                 ///< why nothing is proved, else empty
  std::string remark;                 ///< how it is proved, where that is no bound
  analysis::Assumptions assumptions;  ///< what the proof rests on; the ledger says whether it stands
  sim::Duration from;                 ///< since the start: the requirement counts from then on
};

struct ProofOptions {
  std::uint64_t states = 3'000'000;  ///< to explore at most, for the invariants of all Programs
  std::function<bool()> interrupted;
};

/// By requirement. `bounds` are those of the scenario.
std::vector<Proof> prove(const scenario::Resolved& resolved, const analysis::Bounds& bounds,
                         const std::vector<results::RequirementResult>& requirements, const ProofOptions& options);

}  // namespace takt::verify
