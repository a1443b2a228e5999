// SPDX-License-Identifier: Apache-2.0
// A part of a divided run: a network of which only some nodes act, and the mail between it and the other parts.
//
// Parts synchronise as Chandy and Misra proposed (conservatively, by promises instead of barriers): a part goes on to
// just before the earliest instant at which something may still come from another part, and tells each other part from
// when on what it sends may come: not before the next thing that happens here, the shortest frame, the cable and what
// the receiver needs are over.
#pragma once

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <memory>
#include <vector>

#include "models/network.hpp"
#include "models/parts/bell.hpp"
#include "models/parts/crossing_watcher.hpp"
#include "models/parts/mailbox.hpp"
#include "sim/simulation.hpp"

namespace takt::models {

class Part {
 public:
  /// A neighbour, and what is between: `promise` is the shortest time from an event here to one of its effects there.
  struct Neighbour {
    std::uint32_t part = 0;
    sim::Duration promise;
    Mailbox* to = nullptr;
    Mailbox* from = nullptr;
    Bell* bell = nullptr;  ///< the neighbour's
  };

  /// Both outlive the part. `parts` is how many there are in all; `is_crowded`: more than the machine has processors.
  Part(sim::Simulation& simulation, Network& network, std::uint32_t parts, bool is_crowded)
      : simulation_(&simulation), network_(&network), is_crowded_(is_crowded), outgoing_(parts) {}

  void add_neighbour(const Neighbour& neighbour) {
    neighbours_.push_back(neighbour);
    shortest_promise_ = std::min(shortest_promise_, neighbour.promise);
  }

  /// See FrameExchange.
  void send(std::uint32_t part, const sim::Event& arrival, FrameIndex frame);

  /// Observer of frames between parts, or null.
  void set_watcher(CrossingWatcher* watcher) { watcher_ = watcher; }

  /// What wakes this part.
  Bell& bell() { return bell_; }

  /// Goes on until `until`, together with the other parts, whose threads do the same; gives up when `stop` is set, for
  /// which bell() is rung.
  void advance(sim::TrueTime until, const std::atomic<bool>& stop);
  /// Takes what has been posted, whenever it is due. When the other parts have come to an end, too.
  void receive_posted();

 private:
  sim::TrueTime safe_until() const;
  void post(sim::TrueTime safe);

  sim::Simulation* simulation_;
  Network* network_;
  bool is_crowded_;
  CrossingWatcher* watcher_ = nullptr;
  Bell bell_;
  std::vector<Neighbour> neighbours_;
  sim::Duration shortest_promise_ = sim::Duration::from_ps(INT64_MAX);
  std::vector<Consignment> outgoing_;  // by part
  Consignment incoming_;
  std::vector<FrameIndex> sent_;  // copies that have left; the port that sent them still looks at their records
};

}  // namespace takt::models
