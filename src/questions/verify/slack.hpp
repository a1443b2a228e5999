// SPDX-License-Identifier: Apache-2.0
// Where a bound and the worst run that was found part: what each part of the way takes in the run, and what the bound
// grants it.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "analysis/bounds.hpp"
#include "results/run_result.hpp"
#include "scenario/description/description.hpp"

namespace takt::verify {

/// One part of a latency or of a reaction. The parts of the run add up to what was measured, those of the bound to the
/// bound.
struct SlackPart {
  std::string where;  ///< "sw0:1", "slave1 to master"
  std::string what;   ///< what the bound reckons with there: "blocking and other frames"
  sim::Duration bound;
  sim::Duration run;
  sim::Duration given_away() const { return bound - run; }
};

/// Whether so much of a bound is reached that nothing need be said: 90 % of reactions, 85 % of all else.
bool is_tight(results::RequirementKind kind, double tightness);

/// What is asked about: a requirement with the greatest figure of a run and its bound.
struct LooseEnd {
  const results::RequirementResult& requirement;
  sim::Duration measured;  ///< in the run of `worst`
  sim::Duration bound;
  const scenario::Scenario& worst;
};

/// Replays the worst run; the parts, in the order of the way. Nothing if the figure is of a frame that is still under
/// way at the end, of a kind that has no parts, or if `interrupted` says so.
std::vector<SlackPart> parts_in_order(const LooseEnd& end, const analysis::Bounds& bounds,
                                      const std::function<bool()>& interrupted);
/// The same, from the one that gives most away.
std::vector<SlackPart> slack_of(const LooseEnd& end, const analysis::Bounds& bounds,
                                const std::function<bool()>& interrupted);

}  // namespace takt::verify
