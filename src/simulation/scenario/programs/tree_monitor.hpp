// SPDX-License-Identifier: Apache-2.0
// What a run learns about a tree of nested Programs: the invariants of the tree, and how long all of it takes to react.
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "handshake/observer.hpp"
#include "handshake/reaction.hpp"
#include "sim/simulation.hpp"

namespace takt::scenario {

/// Stands beside the ProgramMonitors of its programs, which hand on what they see.
class TreeMonitor {
 public:
  struct Violation {
    sim::TrueTime time;
    handshake::Violation violation;
  };

  /// `programs`: numbers of the run's programs in the order of `groups`.
  TreeMonitor(sim::Simulation& simulation, std::vector<std::uint32_t> programs,
              std::vector<handshake::TreeGroup> groups)
      : simulation_(&simulation),
        programs_(std::move(programs)),
        observer_(handshake::Variant::robust, handshake::GroupTree(std::move(groups))),
        reactions_(observer_.tree().participants()) {}

  void on_step(std::size_t group, std::size_t participant, const handshake::Outputs& outputs,
               const handshake::Word& after, const handshake::Origin& origin);
  void on_crash(std::size_t group, std::size_t participant);
  /// The participant is nobody any more, without a fault: its role has another node, or none.
  void on_gone(std::size_t group, std::size_t participant);
  void on_back(std::size_t group, std::size_t participant);

  const std::vector<std::uint32_t>& programs() const { return programs_; }
  std::span<const handshake::Reaction> reactions() const { return reactions_.reactions(); }
  /// Program (its number in the run) and participant of a reaction's initiator.
  std::pair<std::uint32_t, std::uint8_t> initiator_of(const handshake::Reaction& reaction) const;
  /// Only of the tree as a whole; the rest is with the programs.
  const std::vector<Violation>& violations() const { return violations_; }

 private:
  sim::Simulation* simulation_;
  std::vector<std::uint32_t> programs_;
  handshake::Observer observer_;
  handshake::TreeReactions reactions_;
  std::size_t seen_ = 0;
  std::vector<Violation> violations_;
};

}  // namespace takt::scenario
