// SPDX-License-Identifier: Apache-2.0
// How long a group takes to react, from the longest ways of notifications along its handshake (max-plus).
//
// A notification is on its way from the change of a participant's word to the step of another that hears it: wait for
// the next publication (a cycle and the wake-up, nothing if it publishes on change), and the latency of its state
// message.
#pragma once

#include <string>
#include <vector>

#include "analysis/bounds.hpp"
#include "analysis/max_plus.hpp"

namespace takt::analysis {

/// A group: participant 0 is the master. notify(i, j): from a change at j until i has heard of it; zero() if i does not
/// listen to j. initialise[i]: how long i stays in INIT.
struct ReactionGroup {
  std::vector<std::string> names = {};  ///< of the participants, for the parts of a bound
  MaxPlusMatrix notify{0, 0};
  std::vector<MaxPlus> initialise;
  std::vector<bool> origins = {};  ///< by participant: at whom calls may be made; at any if empty
  /// Groups within: a slave that is master of another group.
  struct Inner;
  std::vector<Inner> inner;
};
struct ReactionGroup::Inner {
  std::size_t slave = 0;
  ReactionGroup group;
};

/// From the master's INIT to its Ready, when all slaves are Ready; a slave with an inner group is Ready when that is.
MaxPlus ready_bound(const ReactionGroup& group);
/// From the master's Ready to its Running, when all slaves are Running; likewise with inner groups.
MaxPlus run_bound(const ReactionGroup& group);
/// From Start at the master to the moment at which everybody is Running.
MaxPlus start_bound(const ReactionGroup& group);
/// The slowest chain of a start in its parts, whose durations sum up to start_bound. Precondition: that is bounded, and
/// there are names.
std::vector<ReactionPart> ready_parts(const ReactionGroup& group);
std::vector<ReactionPart> run_parts(const ReactionGroup& group);

/// What is asked of all groups of a tree.
enum class Spread : std::uint8_t {
  at_once,         ///< halt, resume, reset: a node in two groups passes it on in the same step
  after_barriers,  ///< suspend: upwards not before the node has heard that its outer master is past the barrier
};
/// One participant hears of another; numbered from the outermost master on, each group's slaves after its master.
struct SpreadStep {
  std::size_t from = 0;
  std::size_t to = 0;
  MaxPlus takes;
};
/// The slowest way of a call from where it is made to the last who hears of it.
std::vector<SpreadStep> slowest_spread(const ReactionGroup& group, Spread spread = Spread::at_once);
/// The same in words. Precondition: there are names.
std::vector<ReactionPart> spread_parts(const ReactionGroup& group, Spread spread = Spread::at_once);
/// From a call at any of the origins, of any of the groups, until the last of all has heard of it: halt, suspend,
/// resume, reset.
MaxPlus spread_bound(const ReactionGroup& group, Spread spread = Spread::at_once);

}  // namespace takt::analysis
