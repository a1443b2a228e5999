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

/// Among `candidates`, the classes with a frame at their head, the most urgent one that may start at this instant.
///
/// Strict priority alone lets every class start. Gates, shapers and the MAC's hold request join here as pure pieces: each
/// takes away from `candidates` the classes that may not start now and lowers `ask_again` to the instant at which one of
/// them may. No lower class is blocked by a higher one that may not start (8.6.8.4).
inline Selection select_transmission(ClassSet candidates) {
  if (candidates == 0) return {};
  return {true, highest_class(candidates), sim::TrueTime::never()};
}

}  // namespace takt::models
