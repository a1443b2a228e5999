// SPDX-License-Identifier: Apache-2.0
// Is this a schedule of that problem? Says so from the definitions and trusts nothing that was worked out before.
#pragma once

#include <string>
#include <vector>

#include "scenario/resolved/gate_problem.hpp"

namespace takt::schedule_check {

/// What is wrong, one sentence each, at most `most`; empty if the schedule is sound:
///
/// - each stream has one window a hop; its frame begins when it can be there, not later, unless it follows a frame of
/// its train that it has
///   followed since the talker; no frame is there before;
/// - for every frame of a cycle and wherever its clock may be within the margin, the gate of its class is open from its
/// begin to its end, and
///   the gates of classes without windows are closed, from a guard before on;
/// - frames of different trains, or of one train that come by different ways, never meet, whatever the clocks say
/// within the margin; of two ways behind a merge of copies a frame takes one;
/// - a scheduled class is open in its windows only (to the ns), and the other classes are open in all that is left;
/// - where the device of a port has limits they are kept; then time of the other classes may be missing, and while they
/// are closed a scheduled class may be open outside its windows
///   if none of its frames waits there for a window;
/// - cycles are common multiples of the periods, and the lists are such as ports take: 1 to 1024 entries of at least 1
/// ns that fill the cycle.
std::vector<std::string> check(const scenario::GateProblem& problem, const scenario::GateSolution& schedule,
                               std::size_t most = 20);

}  // namespace takt::schedule_check
