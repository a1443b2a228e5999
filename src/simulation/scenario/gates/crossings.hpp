// SPDX-License-Identifier: Apache-2.0
// Which frame is at which port when, of streams whose frames come at known times: what they occupy, and who may be at a
// port in which order. All that lays gates or chooses offsets asks here, so that both mean the same by "they meet".
#pragma once

#include <cstdint>
#include <vector>

#include "scenario/resolved/gate_problem.hpp"

namespace takt::scenario {

/// Towards minus infinity.
sim::Duration floor_ns(sim::Duration d);
/// From 0 to m - 1.
constexpr std::int64_t modulo(std::int64_t a, std::int64_t m) { return (a % m + m) % m; }

/// Where frames wait that come before their release.
enum class Waiting : std::uint8_t {
  at_gates,  ///< at the talker's port, whose window opens at the release
  nowhere,   ///< they go as they come: all ports behind see how early they were
};

/// A stream at a hop.
struct Crossing {
  std::uint32_t stream = 0;
  std::uint32_t hop = 0;
};

class Crossings {
 public:
  Crossings(const GateProblem& problem, Waiting waiting);

  /// Those of a port, by stream and hop.
  const std::vector<Crossing>& at(std::uint32_t port) const { return at_[port]; }
  const ScheduledHop& hop(Crossing c) const { return problem_->streams[c.stream].hops[c.hop]; }
  /// With `Waiting::nowhere` only its start means anything.
  const StreamWindow& window(Crossing c) const { return windows_[c.stream][c.hop]; }
  const std::vector<std::vector<StreamWindow>>& windows() const { return windows_; }

  /// Its first frame may begin by then, as the clocks go. At the talker no margin: it is the talker's own clock.
  sim::Duration earliest(Crossing c) const;
  /// The end of what keeps others away: the gap behind the latest frame is part of it.
  sim::Duration free_again(Crossing c) const;
  /// The later of two of one train came to the port behind the earlier, by the same port before: they stay in order,
  /// whatever the clocks say.
  bool follows(Crossing later, Crossing earlier) const;
  /// Of one frame: a copy that leaves the talker by the same port behind the other one, or the other way on which it
  /// may come from a merge, of which it takes one. `later` begins later. Copies that come to one port by two ways are
  /// as apart as any two frames.
  bool is_same_frame(Crossing later, Crossing earlier) const;
  /// At their talker, in one queue behind gates: the first to come would stand in the window of the other. `common`
  /// divides both periods, ps.
  bool come_in_any_order(Crossing a, Crossing b, std::int64_t common) const;
  /// Whether that can be with other releases: they share a queue at a talker whose gates hold them, and one of them may
  /// be early.
  bool share_a_queue(Crossing a, Crossing b) const;

 private:
  void follow(std::uint32_t stream);

  const GateProblem* problem_;
  Waiting waiting_;
  std::vector<std::vector<Crossing>> at_;           // by port
  std::vector<std::vector<StreamWindow>> windows_;  // by stream and hop
};

}  // namespace takt::scenario
