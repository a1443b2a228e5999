// SPDX-License-Identifier: Apache-2.0
// The same plant with less waiting, so that a search can afford many runs of it.
#pragma once

#include <cstdint>

#include "scenario/description/description.hpp"

namespace takt::verify {

/// How much is left between two events: what Programs need if all goes as it is planned, or plenty.
enum class Pauses : std::uint8_t { brief, ample };

/// Calls of the script, cuts of links and crashes come closer to each other, and the end to the last of them, where
/// nothing but what is periodic goes on in between. What is left between two of them is
/// long enough for `longest_reaction`, for an initialisation and a time-out, and the same in phase. Without such events
/// the end comes after two common periods of all streams, or twenty of the longest.
/// A scenario in which more depends on when something happens (gPTP, clocks, other faults, other gate lists, traces,
/// applications) stays as it is. Who relies on it compares what happens in both.
scenario::Scenario shortened(const scenario::Scenario& scenario, sim::Duration longest_reaction,
                             Pauses pauses = Pauses::ample);

}  // namespace takt::verify
