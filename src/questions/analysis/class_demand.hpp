// SPDX-License-Identifier: Apache-2.0
// What comes to one class of a port: work in any interval, from the arrival curves of its flows and the links by which
// they come.
#pragma once

#include <optional>
#include <vector>

#include "analysis/port_bound.hpp"

namespace takt::analysis {

class ClassDemand {
 public:
  /// The flows of `traffic` that may be in one of these classes, on a port with that octet time. Those of cyclic
  /// queuing and forwarding take turns, and are in classes `of_turns` alone.
  ClassDemand(const PortTraffic& traffic, models::ClassSet classes, Ps octet_time, models::ClassSet of_turns = 0xFF);

  bool is_empty() const { return groups_.empty(); }
  /// The most work that comes in a closed interval of that length. Unbounded if a flow is, and its link does not limit
  /// it.
  Ps work(Ps length) const;
  /// The most frames, likewise.
  std::int64_t frames(Ps length) const;
  /// work(t) <= burst() + rate() * t; infinite where there is no such line.
  double rate() const { return rate_; }
  double burst() const { return burst_; }
  /// What comes in each `length`, which is a multiple of all periods, from settled_after() on.
  Ps work_in_each(Ps length) const;
  /// Links limit nothing any more in intervals that are longer. Unbounded if they always may.
  Ps settled_after() const;
  /// The least common multiple of the periods of all flows and this one; nothing if that is longer than `most`, or if
  /// there is none.
  std::optional<Ps> common_period(Ps period, Ps most) const;
  /// Work of the longest and of the shortest frame.
  Ps longest() const { return longest_; }
  Ps shortest() const { return shortest_; }

  /// Lengths at which work() jumps or bends, ascending, from 0 to `end`; empty if there are more than `most`.
  std::vector<Ps> bends(Ps end, std::size_t most) const;
  /// How fast work() grows just after that length, as a share of the port's rate.
  double slope_after(Ps length) const;

 private:
  struct Flow {
    const FrameArrivals* arrivals;
    Ps work = 0;   // of one frame, the longest
    Ps least = 0;  // of the shortest
  };
  struct Group {  // what comes by one link
    std::vector<Flow> flows;
    Ps link_octet = 0;       // 0: no limit
    Ps at_once = 0;          // what the link may bring at one instant
    bool is_limited = true;  // all flows are
  };
  Ps flows_work(const Group& group, Ps length) const;
  Ps link_work(const Group& group, Ps length) const;

  std::vector<Group> groups_;
  Ps octet_time_;
  Ps longest_ = 0;
  Ps shortest_ = 0;
  double rate_ = 0;
  double burst_ = 0;
};

}  // namespace takt::analysis
