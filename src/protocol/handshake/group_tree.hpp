// SPDX-License-Identifier: Apache-2.0
// Groups in groups: who is where. A single group is a tree of one.
//
// Participants are numbered through, a group's one after the other, its master first. An inner master and the slave
// that it is in the outer group are on one node.
#pragma once

#include <cstddef>
#include <utility>
#include <vector>

#include "sim/check.hpp"

namespace takt::handshake {

/// A group's place in the tree. Group 0 is the root; an outer group stands before its inner ones.
struct TreeGroup {
  std::size_t participants = 2;
  std::size_t outer = 0;        ///< group in which its master is a slave; none for the root
  std::size_t outer_index = 0;  ///< participant that its master is there; 0: the root
  bool operator==(const TreeGroup&) const = default;
};

class GroupTree {
 public:
  static constexpr std::size_t most_in_group = 65;

  explicit GroupTree(std::vector<TreeGroup> groups) : groups_(std::move(groups)) {
    TAKT_CHECK(!groups_.empty(), "a tree has a root");
    for (std::size_t g = 0; g < groups_.size(); ++g) {
      TAKT_CHECK(g == 0 ? groups_[g].outer_index == 0 : groups_[g].outer < g && groups_[g].outer_index != 0,
                 "an inner group's master is a slave of a group before it");
      TAKT_CHECK(groups_[g].participants >= 2 && groups_[g].participants <= most_in_group,
                 "a group has a master and 1 to 64 slaves");
      first_.push_back(group_of_.size());
      group_of_.insert(group_of_.end(), groups_[g].participants, g);
    }
  }
  explicit GroupTree(std::size_t participants) : GroupTree(std::vector<TreeGroup>{{participants, 0, 0}}) {}

  std::size_t groups() const { return groups_.size(); }
  std::size_t participants() const { return group_of_.size(); }
  const TreeGroup& group(std::size_t group) const { return groups_[group]; }
  std::size_t size(std::size_t group) const { return groups_[group].participants; }
  std::size_t number_of(std::size_t group, std::size_t index) const { return first_[group] + index; }
  std::size_t group_of(std::size_t number) const { return group_of_[number]; }
  std::size_t index_of(std::size_t number) const { return number - first_[group_of_[number]]; }
  bool is_inner_master(std::size_t number) const { return group_of_[number] != 0 && index_of(number) == 0; }
  /// The same node in the group outside; of an inner master.
  std::size_t outer_number(std::size_t number) const {
    const TreeGroup& inner = groups_[group_of_[number]];
    return number_of(inner.outer, inner.outer_index);
  }

  /// Whether a group hangs below a participant: a master's own group does, too.
  bool is_below(std::size_t group, std::size_t top) const {
    const bool is_master = index_of(top) == 0;
    if (group == group_of_[top]) return is_master;
    for (; group != 0; group = groups_[group].outer)
      if (groups_[group].outer == group_of_[top]) return is_master || groups_[group].outer_index == index_of(top);
    return false;
  }
  bool operator==(const GroupTree&) const = default;

 private:
  std::vector<TreeGroup> groups_;
  std::vector<std::size_t> first_;     ///< by group: number of its master
  std::vector<std::size_t> group_of_;  ///< by number
};

}  // namespace takt::handshake
