// SPDX-License-Identifier: Apache-2.0
// A group, or two of which one is nested in the other: who is where, and who hears whom.
//
// Participants are numbered through: 0 to S the outer group (0 its master), then the inner one from its master on. The
// last slave of the outer group and the inner master are one node; every other participant is a node by itself.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "explore/model/query.hpp"
#include "handshake/coupling.hpp"
#include "handshake/group_tree.hpp"

namespace takt::explore {

class TreeShape {
 public:
  static constexpr std::size_t most_participants = most_outer_slaves + most_inner_slaves + 2;

  struct Channel {
    std::uint8_t sender = 0;  ///< participant
    std::uint8_t receiver = 0;
    std::uint8_t peer = 0;  ///< the sender, among the peers of the receiver
  };

  explicit TreeShape(const Query& query)
      : tree_(groups_of(query)),
        outer_(query.slaves + 1U),
        inner_(query.nested() ? query.inner_slaves + 1U : 0U),
        joins_(query.joining) {
    for (std::size_t p = 0; p < participants(); ++p) node_of_[p] = static_cast<std::uint8_t>(p < outer_ ? p : p - 1);
    for (std::size_t group = 0; group < groups(); ++group)
      for (std::size_t i = 1; i < size(group); ++i) {
        add(number_of(group, i), number_of(group, 0), i - 1);
        add(number_of(group, 0), number_of(group, i), 0);
      }
  }

  const handshake::GroupTree& tree() const { return tree_; }
  std::size_t groups() const { return tree_.groups(); }
  std::size_t size(std::size_t group) const { return tree_.size(group); }
  std::size_t participants() const { return tree_.participants(); }
  std::size_t nodes() const { return inner_ == 0 ? outer_ : participants() - 1; }
  std::size_t group_of(std::size_t participant) const { return tree_.group_of(participant); }
  std::size_t index_of(std::size_t participant) const { return tree_.index_of(participant); }
  std::size_t number_of(std::size_t group, std::size_t index) const { return tree_.number_of(group, index); }

  bool is_nested(std::size_t node) const { return inner_ != 0 && node == outer_ - 1; }
  std::size_t node_of(std::size_t participant) const { return node_of_[participant]; }
  handshake::Side side_of(std::size_t participant) const {
    return inner_ != 0 && participant == outer_ ? handshake::Side::inner : handshake::Side::outer;
  }
  /// Which of a node's participants: Inner is the master of the inner group.
  std::size_t participant_of(std::size_t node, handshake::Side side) const {
    return side == handshake::Side::inner ? outer_ : node < outer_ ? node : node + 1;
  }
  /// The participant that a peer index stands for.
  std::size_t peer_of(std::size_t participant, std::size_t peer) const {
    const std::size_t group = group_of(participant);
    return number_of(group, index_of(participant) == 0 ? peer + 1 : 0);
  }
  /// Who is down at the beginning; nodes() if nobody is.
  std::size_t joining_node() const { return joins_ ? nodes() - 1 : nodes(); }

  std::size_t channels() const { return channel_count_; }
  const Channel& channel(std::size_t channel) const { return channels_[channel]; }
  std::size_t channel_between(std::size_t sender, std::size_t receiver) const {
    std::size_t c = 0;
    while (channels_[c].sender != sender || channels_[c].receiver != receiver) ++c;
    return c;
  }

  std::string name(std::size_t participant) const {
    const std::size_t index = index_of(participant);
    return std::string(group_of(participant) == 0 ? "" : "inner ") +
           (index == 0 ? "master" : "slave " + std::to_string(index));
  }
  std::string node_name(std::size_t node) const {
    return is_nested(node) ? "the node of " + name(node) + " and inner master"
                           : name(participant_of(node, handshake::Side::outer));
  }

 private:
  static std::vector<handshake::TreeGroup> groups_of(const Query& query) {
    std::vector<handshake::TreeGroup> groups{{query.slaves + std::size_t{1}, 0, 0}};
    if (query.nested()) groups.push_back({query.inner_slaves + std::size_t{1}, 0, query.slaves});
    return groups;
  }
  void add(std::size_t sender, std::size_t receiver, std::size_t peer) {
    channels_[channel_count_++] = {static_cast<std::uint8_t>(sender), static_cast<std::uint8_t>(receiver),
                                   static_cast<std::uint8_t>(peer)};
  }

  handshake::GroupTree tree_;
  std::size_t outer_;  ///< participants of the outer group
  std::size_t inner_;
  bool joins_;
  std::array<std::uint8_t, most_participants> node_of_{};
  std::size_t channel_count_ = 0;
  std::array<Channel, 2 * (most_outer_slaves + most_inner_slaves)> channels_{};
};

}  // namespace takt::explore
