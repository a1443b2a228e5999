// SPDX-License-Identifier: Apache-2.0
// What takt verify says of a variant, in the figures of a study: the one place of it that asks src/questions/verify.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "study/plan.hpp"
#include "verify/verification.hpp"

namespace takt::study {

struct Verified {
  std::vector<std::optional<double>>
      values;  ///< by measure of the plan, in its unit; none of a figure of the run, or where there is none
  verify::Conclusion verdict{};  ///< of the scenario's own requirements
  bool is_required = false;      ///< it has some
  std::string contradiction;     ///< a run exceeds what is proved, a mistake of takt; else empty
};

/// Verifies the scenario, whatever phases and chance bring, within the study's budget. `ran` is a run that it allows,
/// with `of_run`: by measure its figure, of measures worst.X and bound.X that of X; `run_fails`: it fails a
/// requirement. That run counts among those that were found.
///
/// worst.X is none if some run has no X at all, such as a halt that is never complete; bound.X is none if nothing
/// bounds it.
Verified verify_variant(const Plan& plan, const scenario::Scenario& scenario, const scenario::Scenario& ran,
                        const std::vector<std::optional<double>>& of_run, bool run_fails, unsigned threads);

}  // namespace takt::study
