// SPDX-License-Identifier: Apache-2.0
// Follows the gates of the ports of a network along their lists, for who draws them; copies, so that no port notices.
#pragma once

#include <queue>
#include <vector>

#include "models/port_directory.hpp"

namespace takt::output {

class GateFollower {
 public:
  /// From `now` on, the present instant. Both outlive it. Of a part of a divided run only the part's own ports have
  /// gates.
  GateFollower(const models::Network& network, const models::PortDirectory& directory, sim::TrueTime now = {});

  /// Whether the port, by its position in the directory, has gates at present.
  bool has_gates(std::uint32_t position) const;
  /// The gates of the port, or the clock that they go by, are others from now on. What comes before has been popped.
  void look_at(std::uint32_t position, sim::TrueTime now);
  /// Bit q: the gate of class q is open, broken ones as they are stuck. Times ascend.
  std::uint64_t states(std::uint32_t position, sim::TrueTime at);

  struct Change {
    sim::TrueTime time;
    std::uint32_t position = 0;
    friend bool operator>(const Change& a, const Change& b) {
      return a.time != b.time ? a.time > b.time : a.position > b.position;
    }
  };
  /// When gates change next; never() if they do not.
  sim::TrueTime next_time();
  /// The next change. Precondition: there is one.
  Change pop();

 private:
  struct Gates {
    models::GateSchedule schedule;
    bool is_there = false;
    models::GateStates stuck_open = 0;
    models::GateStates not_stuck_closed = 0xFF;
    sim::TrueTime next = sim::TrueTime::never();  // when they next change
  };
  const models::EgressPort& live(std::uint32_t position) const;
  void follow(std::uint32_t position);

  const models::Network* network_;
  const models::PortDirectory* directory_;
  std::vector<Gates> gates_;  // by port
  std::priority_queue<Change, std::vector<Change>, std::greater<>>
      changes_;  // those of lists that were replaced are stale
};

}  // namespace takt::output
