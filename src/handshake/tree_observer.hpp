// The ghost observer of nested groups: each group's own invariants, and S1 and S2 for the tree as a whole.
//
//   S1 nobody in the tree is Running in a run of the tree before every node was Ready in it
//   S2 whoever has groups below it is Running only after everybody there was Running in it
//
// A run of the tree is a run of the root group with the inner runs that were started for it. A node is Ready or Running as the
// slave of its group, the root as the master of its own: an inner master shows INIT while it waits for the outer barrier, and that
// its group is prepared is what the same node's outer Ready says. `robust` only, like nesting.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "handshake/invariants.hpp"
#include "handshake/reaction.hpp"

namespace takt::handshake {

/// A group's place in the tree. Group 0 is the root; an outer group stands before its inner ones.
struct TreeGroup {
  std::size_t participants = 2;
  std::size_t outer = 0;         ///< group in which its master is a slave; none for the root
  std::size_t outer_index = 0;   ///< participant that its master is there; 0: the root
};

struct TreeViolation {
  std::size_t group = 0;
  Violation violation;
  bool of_tree = false;  ///< S1 and S2 of the whole tree; else of the group alone
  constexpr bool operator==(const TreeViolation&) const = default;
};

class TreeObserver {
 public:
  explicit TreeObserver(std::vector<TreeGroup> groups);

  void on_step(std::size_t group, std::size_t participant, const Outputs& outputs, const Word& after);
  void on_restart(std::size_t group, std::size_t participant);
  std::uint32_t sending_run(std::size_t group, std::size_t participant) const { return observers_[group].sending_run(participant); }
  void on_process_data(std::size_t group, std::size_t from, std::size_t to, std::uint32_t sent_in);

  /// Of the groups and of the tree, in the order of their discovery.
  std::span<const TreeViolation> violations() const { return violations_; }
  const std::vector<TreeGroup>& groups() const { return groups_; }
  /// The number of a participant among those of all groups, a group's one after the other.
  std::size_t number_of(std::size_t group, std::size_t participant) const { return first_[group] + participant; }
  std::size_t participants() const { return last_words_.size(); }

 private:
  /// A run of an inner group and that of the outer one for which it was started.
  struct Link {
    std::size_t group = 0;
    std::uint32_t inner = 0;
    std::uint32_t outer = 0;
  };
  /// What happened in a run of the tree, by participant number.
  struct Facts {
    std::uint32_t run = 0;
    std::vector<bool> ready;
    std::vector<bool> running;
  };

  bool is_node(std::size_t group, std::size_t participant) const { return group == 0 || participant != 0; }
  bool is_below(std::size_t group, std::size_t top, std::size_t top_participant) const;
  std::uint32_t tree_run(std::size_t group, std::uint32_t run) const;
  Facts& facts_of(std::uint32_t tree_run);
  void became_running(std::size_t group, std::size_t participant, const Word& after);
  void report(Invariant invariant, Finding finding, std::size_t group, std::size_t participant);
  void take_violations(std::size_t group);

  std::vector<TreeGroup> groups_;
  std::vector<std::size_t> first_;       ///< by group: number of its master
  std::vector<GroupObserver> observers_;
  std::vector<std::size_t> taken_;       ///< by group: violations already taken over
  std::vector<Word> last_words_;         ///< by participant number
  std::vector<Link> links_;
  std::vector<Facts> facts_;
  std::vector<TreeViolation> violations_;
};

/// Reaction times of the whole tree: until the participants of all its groups have reached the state that was asked for.
/// What one group only passes on to the other is no reaction of its own. Of two reactions the later supersedes.
class TreeReactions {
 public:
  explicit TreeReactions(std::size_t participants) : tracker_(participants) {}
  void on_step(std::size_t number, const Outputs& outputs, sim::TrueTime at, const Origin& origin = {});
  void on_crash(std::size_t number, sim::TrueTime at) { tracker_.on_crash(number, at); }
  void on_restart(std::size_t number, sim::TrueTime at) { tracker_.on_restart(number, at); }
  std::span<const Reaction> reactions() const { return tracker_.reactions(); }

 private:
  ReactionTracker tracker_;
};

}  // namespace takt::handshake
