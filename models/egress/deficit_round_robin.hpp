// SPDX-License-Identifier: Apache-2.0
// Enhanced transmission selection (IEEE 802.1Q 8.6.8.3, clause 37): whose turn it is among the classes that share
// bandwidth.
//
// The standard leaves the algorithm to the implementation. This is deficit round robin (Shreedhar and Varghese 1995):
// in a round, from class 7 down to 0, each class that has a frame is given so many octets as its percentage says, and
// sends what it has got octets for. Octets are those of the medium, preamble and gap included. So as long as two
// classes have frames their octets differ from their proportion by less than a frame and a quantum of each; who has
// none gets nothing, and the others share all. Somebody sends whenever somebody may.
#pragma once

#include <array>
#include <cstdint>

#include "models/ethernet/frame.hpp"

namespace takt::models {

class DeficitRoundRobin {
 public:
  using PerClass = std::array<std::int64_t, traffic_class_count>;

  /// The octets of each class in a round; 0: it does not take part.
  explicit DeficitRoundRobin(const PerClass& quanta) : quanta_(quanta) {}

  /// The class that sends next. `first`: the octets of the frame that each class could start at once, 0 without one;
  /// some class has one. Nothing counts until started() says that it was so.
  TrafficClass choose(const PerClass& first);
  /// The class that choose() has said last sends that frame. `queue_is_empty`: it has no other, and what it has left is
  /// lost.
  void started(TrafficClass q, std::int64_t octets, bool queue_is_empty);
  /// The class has no frame any more, for another reason.
  void emptied(TrafficClass q) { now_.deficits[q] = 0; }

 private:
  struct State {
    TrafficClass turn = 0;  // the class that got octets last
    PerClass deficits{};    // what each may still send
  };

  PerClass quanta_;
  State now_;
  State chosen_;  // by the last choose()
};

}  // namespace takt::models
