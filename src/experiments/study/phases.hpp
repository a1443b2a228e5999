// SPDX-License-Identifier: Apache-2.0
// Phases that nobody gave: a study draws them by the seed, where a run of takt takes 0.
#pragma once

#include "scenario/description/description.hpp"

namespace takt::study {

/// With a phase for each talker and publisher that a plant would start at any instant of its period
/// (verify/free_variable.hpp): the same share of the period for the same seed and name, whatever the variant. A file of
/// it replays the run.
scenario::Scenario with_drawn_phases(const scenario::Scenario& scenario);

}  // namespace takt::study
