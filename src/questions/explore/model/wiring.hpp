// SPDX-License-Identifier: Apache-2.0
// Who hears whom, as numbered channels: 0 to n-1 from the slaves to the master, n to 2 n - 1 from the master to the
// slaves, and with all-to-all subscription after them the pairs of different slaves.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

#include "explore/model/query.hpp"

namespace takt::explore {

inline constexpr std::size_t most_participants = most_slaves + 1;
inline constexpr std::size_t most_channels = 12;  ///< of a group whose slaves have names
inline constexpr std::size_t most_wired = most_equal_slaves + 1;

class Wiring {
 public:
  explicit Wiring(const Query& query) {
    const std::size_t slaves = query.slaves;
    for (std::size_t i = 1; i <= slaves; ++i) add(i, 0);
    for (std::size_t i = 1; i <= slaves; ++i) add(0, i);
    if (query.subscription == handshake::Subscription::star) return;
    for (std::size_t from = 1; from <= slaves; ++from)
      for (std::size_t to = 1; to <= slaves; ++to)
        if (from != to) add(from, to);
  }

  std::size_t size() const { return size_; }
  std::size_t sender(std::size_t channel) const { return ends_[channel].sender; }
  std::size_t receiver(std::size_t channel) const { return ends_[channel].receiver; }
  /// The index of the sender among the peers of the receiver.
  std::uint8_t peer(std::size_t channel) const { return ends_[channel].peer; }
  std::size_t channel(std::size_t sender, std::size_t receiver) const { return channel_[sender][receiver]; }

 private:
  struct Ends {
    std::uint8_t sender = 0;
    std::uint8_t receiver = 0;
    std::uint8_t peer = 0;
  };
  void add(std::size_t sender, std::size_t receiver) {
    channel_[sender][receiver] = static_cast<std::uint8_t>(size_);
    ends_[size_++] = {static_cast<std::uint8_t>(sender), static_cast<std::uint8_t>(receiver),
                      static_cast<std::uint8_t>(sender < receiver ? sender : sender - 1)};
  }
  std::size_t size_ = 0;
  std::array<Ends, std::max(most_channels, 2 * most_equal_slaves)> ends_{};
  std::array<std::array<std::uint8_t, most_wired>, most_wired> channel_{};
};

/// The participant that a peer index stands for.
constexpr std::size_t peer_participant(std::size_t participant, std::size_t peer) {
  return peer < participant ? peer : peer + 1;
}

}  // namespace takt::explore
