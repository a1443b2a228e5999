// SPDX-License-Identifier: Apache-2.0
// All phases of a few streams at which frames meet: the worst of them is the worst of all phases.
//
// In a network of ports that send the highest class first and do nothing else, times are sums and maxima of phases and
// constants as long as no two instants change places. So the longest latency is found where
// as many instants as there are phases coincide, or all but: where a frame comes to a port as another one comes or
// starts there. Which instants these are depends on what has waited before; so they are read off
// runs, and each run that is at such a place shows the next ones.
#pragma once

#include "verify/critical.hpp"
#include "verify/trials.hpp"

namespace takt::verify {

/// Whether the argument above holds, there are so few phases that all meetings may be run, and nothing else is free.
bool is_network_of_phases(const scenario::Resolved& resolved, const std::vector<FreeVariable>& variables);
/// Whether all that the phases decide shows within the scenario's duration, so that their differences are all that
/// counts.
bool shows_all_meetings(const scenario::Resolved& resolved, const analysis::Bounds& bounds);

/// Runs meetings, from `beginnings` on, those that follow from the worst runs first. True if there are no more of them.
bool run_meetings(Trials& trials, const CriticalInstants& instants, const scenario::Resolved& resolved,
                  const std::vector<Choice>& beginnings);

}  // namespace takt::verify
