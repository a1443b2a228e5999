// SPDX-License-Identifier: Apache-2.0
// How the nodes of a network are dealt out to the threads of a run.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "scenario/resolved/resolved.hpp"

namespace takt::scenario {

/// What a pair of parts has between them, in one direction.
struct Boundary {
  std::uint32_t from = 0, to = 0;  ///< parts
  Duration promise;  ///< what happens in one is felt in the other no sooner: the shortest frame, the cable, and what
                     ///< the receiver needs
  std::uint32_t links = 0;
  double frames_per_second = 0;  ///< that cross, in the long-term average
};

struct Division {
  std::uint32_t asked = 1;  ///< threads
  std::uint32_t parts = 1;
  std::vector<std::uint32_t> part_of_node;    ///< by node; Programs and applications are in part 0
  std::vector<Boundary> boundaries;           ///< of neighbours, both directions
  std::vector<double> frame_hops_per_second;  ///< by part: frames that come to its nodes, in the long-term average
  std::string why_fewer;                      ///< than asked; empty if there are as many

  bool is_divided() const { return parts > 1; }
  /// The shortest promise. Precondition: is_divided().
  Duration promise() const;
  /// Frames that cross, of all that are on links.
  double crossing_share() const;
};

/// At most `threads` parts, fewer where more would not be faster. What one thread must see stays together: links that
/// may fail, cut through or preempt; all nodes with Programs and applications; hosts with one cable and their switch.
Division divide(const Resolved& resolved, unsigned threads);

/// Nothing but what must stay together counts: for tests. Parts are drawn by `seed`, and may be as small and as many as
/// they like.
Division divide_at_random(const Resolved& resolved, unsigned parts, std::uint64_t seed);

}  // namespace takt::scenario
