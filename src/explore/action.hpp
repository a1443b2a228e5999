// One step of a run: who does what. Network steps are what a fair network does for ever; calls and faults are the
// adversary's and come from a budget.
#pragma once

#include <compare>
#include <cstdint>
#include <string>

namespace takt::explore {

enum class ActionKind : std::uint8_t {
  send,         ///< channel: the sender publishes, so its word of now stands in the register
  receive,      ///< channel: the receiver samples the register
  deliver_late, ///< the delayed copy arrives
  initialised,  ///< participant: its initialisation ends
  silence,      ///< participant, peer: the time-out of a peer that is down expires
  // -- from here on the adversary
  call,         ///< participant, method
  finish,       ///< participant: the Program ends by itself
  lose,         ///< channel: the register's word is lost
  duplicate,    ///< channel: a copy of the register's word stays behind
  reorder,      ///< channel: the register's word is overtaken by the next one
  crash,        ///< participant: it is down
  restart,      ///< participant: it comes up without memory
  timeout,      ///< participant, peer: the time-out of a living peer expires
};

struct Action {
  ActionKind kind = ActionKind::send;
  std::uint8_t who = 0;    ///< participant, or channel: 0 to n-1 slave to master, n to 2n-1 master to slave
  std::uint8_t what = 0;   ///< method (its index), or peer
  constexpr auto operator<=>(const Action&) const = default;
};

constexpr bool is_network(ActionKind kind) { return kind < ActionKind::call; }
constexpr bool is_fault(ActionKind kind) { return kind >= ActionKind::lose; }

/// Channels of a group with so many slaves.
constexpr std::size_t sender_of(std::size_t channel, std::size_t slaves) { return channel < slaves ? channel + 1 : 0; }
constexpr std::size_t receiver_of(std::size_t channel, std::size_t slaves) { return channel < slaves ? 0 : channel - slaves + 1; }
constexpr std::size_t peer_at_receiver(std::size_t channel, std::size_t slaves) { return channel < slaves ? channel : 0; }

}  // namespace takt::explore
