// SPDX-License-Identifier: Apache-2.0
// A gate control list that a device does not take becomes one that it does.
//
// Where no frame ever waits for its gate, windows may be wider than the frames: all that is lost is time of the other
// classes, and that a frame at a wrong time is stopped. So scheduled classes are opened together for as long as the
// others are closed, and the shortest times of the others are given up until the list is short enough.
#pragma once

#include "scenario/resolved/gate_problem.hpp"

namespace takt::scenario {

/// Whether a device with these limits takes the list.
bool keeps_to(const GateList& list, const ListLimits& limits);

struct FittedList {
  ListObstacle obstacle = ListObstacle::none;
  GateList list;           ///< if there is no obstacle
  std::size_t needed = 0;  ///< of too many entries: with so many it holds
};

/// `scheduled`: the classes with windows; the list opens all others outside of them. `has_waiting`: some frame may be
/// at the port before its window opens, or behind one of another class. A list that the device takes stays as it is.
FittedList fit_list(const GateList& list, models::GateStates scheduled, bool has_waiting, const ListLimits& limits);

}  // namespace takt::scenario
