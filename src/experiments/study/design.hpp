// SPDX-License-Identifier: Apache-2.0
// From factors to variants: which combinations of levels are run.
#pragma once

#include "study/expression.hpp"
#include "study/plan.hpp"

namespace takt::study {

/// The levels of a factor as it is written, without those of link failures, which depend on the others. `folder` is
/// where the study lies.
PlannedFactor plan_factor(const Factor& factor, const std::string& folder, json::Diagnostics& diagnostics);

/// The level at a share (0 to 1) of the factor's range. Precondition: it has one, without mistakes.
Level level_between(const Factor& factor, double share, json::Diagnostics& diagnostics);

/// Fills plan.variants (and adds levels that a random design draws). All factors are planned.
void expand(Plan& plan, json::Diagnostics& diagnostics);

/// Adds to each variant the failures of links between switches of its own topology.
void expand_link_failures(Plan& plan, std::size_t factor, json::Diagnostics& diagnostics);

}  // namespace takt::study
