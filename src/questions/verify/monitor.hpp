// SPDX-License-Identifier: Apache-2.0
// Watches runs for what bounds and proofs exclude: an assumption that does not hold, a figure above its bound.
#pragma once

#include <string>
#include <vector>

#include "analysis/bounds.hpp"
#include "results/run_result.hpp"
#include "scenario/run/run.hpp"

namespace takt::verify {

/// An assumption that a run has shown to be wrong.
struct Violation {
  analysis::Assumption assumption;
  std::string witness;
};

/// What a finished run shows of the assumptions that runs can contradict.
std::vector<Violation> violations_in(const scenario::Run& run, const results::RunResult& result);

/// A run above a bound whose assumptions all hold, or that loses what cannot be lost: a mistake of takt. Empty if there
/// is none. Looks at every stream and reaction, required or not.
std::string contradiction_in(const scenario::Resolved& resolved, const analysis::Bounds& bounds,
                             const results::RunResult& result);

}  // namespace takt::verify
