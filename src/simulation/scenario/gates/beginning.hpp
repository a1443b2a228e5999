// SPDX-License-Identifier: Apache-2.0
// When automatic gates begin: clocks that are not synchronised yet would open them at the wrong times, and a frame that
// has missed its window stands before all that follow it.
#pragma once

#include <optional>
#include <utility>
#include <vector>

#include "scenario/description/description.hpp"
#include "scenario/resolved/gate_problem.hpp"

namespace takt::scenario {

/// From when on the scenario says that its clocks are synchronised: the least "after" of its requirements on clocks, or
/// its "warm_up" if there are none. Nothing without gPTP.
std::optional<Duration> clocks_synchronised_from(const Scenario& scenario);

/// A list as it is given to its port.
struct BegunList {
  Duration base_time;
  std::vector<GateList::Entry> entries;
};

/// The list from the instant on at which it may begin, in the phase that it has. It begins behind the longest time of
/// the other classes, in which frames that came too late have left, and so long before the next window that a frame of
/// another class leaves before it. That may take an entry more, if the port has one.
BegunList begun_list(const GateList& list, const GatedPort& port, models::GateStates scheduled, Duration from);

}  // namespace takt::scenario
