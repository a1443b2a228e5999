// Which queue may send now (IEEE 802.1Q clause 8.6.8).
#pragma once

#include "models/egress/frame_queue.hpp"
#include "sim/time.hpp"

namespace takt::models {

/// The answer of transmission selection: a class that may start now, or when to ask again.
struct Selection {
  bool found = false;
  TrafficClass traffic_class = 0;
  sim::TrueTime ask_again = sim::TrueTime::never();  ///< meaningful if nothing was found
};

/// Strict priority alone: of `candidates`, the classes with a frame at their head, the most urgent one. Ports with gates or
/// shapers ask PortShaping::select instead, which passes over the classes that may not start now; no lower class is blocked by
/// such a higher one (8.6.8.4).
inline Selection select_transmission(ClassSet candidates) {
  if (candidates == 0) return {};
  return {true, highest_class(candidates), sim::TrueTime::never()};
}

}  // namespace takt::models
