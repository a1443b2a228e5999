// The clock of a node: what maps true time to the node's own time and back.
#pragma once

#include "sim/time.hpp"

namespace takt::models {

/// A clock that shows true time. Oscillators, servos and steps join here: everything that a node does at a certain time of its
/// own asks this class, so that nothing else changes when clocks begin to drift.
class LocalClock {
 public:
  sim::LocalTime local_at(sim::TrueTime time) const { return sim::LocalTime::from_ps(time.ps()); }
  sim::TrueTime true_at(sim::LocalTime time) const { return sim::TrueTime::from_ps(time.ps()); }
};

}  // namespace takt::models
