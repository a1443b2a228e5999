// SPDX-License-Identifier: Apache-2.0
// Plants for the paper's open questions: one Program that is started, suspended, resumed and halted again and again.
#pragma once

#include <string>
#include <vector>

#include "scenario/description/description.hpp"

namespace takt::papers {

struct Plant {
  std::string variant;  ///< as a table names it
  scenario::Scenario scenario;
};

/// One switch and 1, 2, 4, ... 32 slaves.
std::vector<Plant> plants_by_slaves(int rounds);
/// Stars, lines, trees and rings with up to 16 switches between the master and its farthest slave.
std::vector<Plant> plants_by_topology(int rounds);
/// Best-effort load of 0, 50 and 90 % of each link: strict priority, gates, gates and preemption.
std::vector<Plant> plants_by_load(int rounds);

/// A group at 1 ms, one at 200 us, and the second within the first.
std::vector<Plant> plants_by_nesting(int rounds);

}  // namespace takt::papers
