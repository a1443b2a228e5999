// SPDX-License-Identifier: Apache-2.0
// The least that must go wrong for a point to fail.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "study/plan.hpp"
#include "study/runner.hpp"

namespace takt::study {

struct Shrunk {
  scenario::Scenario scenario;  ///< still fails, by requirements of its own; without any one of its faults it does not
  std::vector<std::string>
      broken;  ///< limits of the study that it breaks: "start <= 7ms"; none if its own requirements are what fails
  std::size_t faults_before = 0;
  std::uint32_t runs = 0;
  bool interrupted = false;
  std::string problem;  ///< why there is none: the point passes, or has no result
};

/// Leaves out faults of a failing point as long as it goes on failing (delta debugging, Zeller and Hildebrandt 2002),
/// then halves how long the remaining ones last. Failing: the run comes to its end and does not pass, as the study
/// judges. The study's limits become requirements of the scenario (in place of its own where these do not count), so
/// that `takt run` judges likewise.
Shrunk shrink(const Plan& plan, std::uint64_t point, const RunOptions& options);

}  // namespace takt::study
