// SPDX-License-Identifier: Apache-2.0
// What would help: with which other payload, cycle, load, link rate or priority a requirement can be proved that is not
// as things are; and what takes most of its time.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "analysis/bounds.hpp"
#include "results/run_result.hpp"
#include "scenario/resolved/resolved.hpp"
#include "verify/budget.hpp"
#include "verify/found_run.hpp"

namespace takt::verify {

/// One change to the scenario, all else being as it is.
struct Remedy {
  std::string what;                                     ///< "payload of camera at most"
  std::string value;                                    ///< "812B"
  sim::Duration bound;                                  ///< with it
  std::vector<std::string> breaks = {};                 ///< requirements that are proved as things are, and not then
  std::function<void(scenario::Scenario&)> apply = {};  ///< makes the change
};

/// What is asked, what is known of it, and what looking may cost.
struct RemedyQuestion {
  const results::RequirementResult& requirement;
  const analysis::Bounds& bounds;  ///< of the scenario as it is
  std::vector<FoundRun> worst;     ///< its worst runs: with the change they are run again
  unsigned seeds = 1;
  std::uint64_t cost_of_run = 0;  ///< of the scenario as it is, in events
};

/// The cheapest first: what is configured, then what the plant does less often, then what is bought. Looks for each, by
/// bisection over what is proved, and tries what it has found as takt verify would: the scenario with the change is
/// proved, a search with so many seeds finds no run that fails the requirement, and nothing in its runs speaks against
/// what the proof rests on. Where the nearest change that is proved does not pass the search, such as one with which
/// frames are still lost, the nearest that does. The worst runs that are known fail it no more. Finds what is monotone:
/// a bound that is no greater with less payload, load or initialisation, or a faster link. Of a requirement without a
/// limit on a time none, nor where the budget is not enough for the search.
std::vector<Remedy> remedies_for(const scenario::Resolved& resolved, const RemedyQuestion& question, Budget& budget);

/// A part of a latency or a reaction.
struct WeightyPart {
  std::string where;
  std::string what;
  sim::Duration takes;  ///< in all, if it occurs several times
};

/// Of the run that took so long the three parts that took most of it, greatest first. Nothing if the requirement is
/// about no such time.
std::vector<WeightyPart> weightiest_parts(const scenario::Scenario& run, const results::RequirementResult& requirement,
                                          sim::Duration measured, const std::function<bool()>& interrupted);

}  // namespace takt::verify
