// SPDX-License-Identifier: Apache-2.0
// Are clauses satisfiable? A packaged solver, CaDiCaL, says so, with a proof if they are not. Without it nothing is
// ever known.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "schedule/certificate.hpp"

namespace takt::schedule {

/// Whether this build has a solver.
bool has_sat_solver();

struct SatAnswer {
  enum class Verdict : std::uint8_t { satisfiable, unsatisfiable, unknown };
  Verdict verdict = Verdict::unknown;
  std::string proof;  ///< of unsatisfiable ones, in the text form of DRAT
};

/// The same answer whenever it is asked, unless `stop` says so. `conflicts`: after how many it gives up.
SatAnswer solve(std::span<const Clause> clauses, std::uint32_t variables, std::uint32_t conflicts,
                const std::function<bool()>& stop);

}  // namespace takt::schedule
