// SPDX-License-Identifier: Apache-2.0
// One step of a run: who does what. Network steps are what a fair network does for ever; calls and faults are the
// adversary's and come from a budget.
#pragma once

#include <array>
#include <compare>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

namespace takt::explore {

enum class ActionKind : std::uint8_t {
  send,          ///< channel: the sender publishes its word of now
  receive,       ///< channel: the receiver samples the register, or takes the first message
  deliver_late,  ///< the delayed copy arrives; `channels`: channel, and which of its messages
  initialised,   ///< participant: its initialisation ends
  silence,  ///< participant, peer: the time-out expires of a peer that is down, or whose words are taken for old ones
  // -- from here on the adversary
  call,        ///< participant, method
  finish,      ///< participant: the Program ends by itself
  join,        ///< candidate: it begins to announce itself
  leave,       ///< candidate: it asks to be let go, or announces itself no more
  change_key,  ///< participant: from now on it signs with the next key; costs nothing
  lose,        ///< channel: the register's word is lost; `channels`: and which of its messages
  duplicate,   ///< channel: a copy of the register's word stays behind
  reorder,     ///< channel: the register's word is overtaken by the next one
  crash,       ///< participant: it is down
  restart,     ///< participant: it comes up without memory
  timeout,     ///< participant, peer: the time-out of a living peer expires
  forge,       ///< participant: a stranger speaks in its name; which of the words that it may say (forgery.hpp)
  replay,      ///< channel: a stranger hands over what was said before; how many were said after it (recording.hpp)
};

inline constexpr std::array<std::string_view, 18> action_names{
    "send",       "receive", "deliver_late", "initialised", "silence", "call",    "finish",  "join",  "leave",
    "change_key", "lose",    "duplicate",    "reorder",     "crash",   "restart", "timeout", "forge", "replay"};
static_assert(action_names.size() == static_cast<std::size_t>(ActionKind::replay) + 1);
constexpr std::string_view name_of(ActionKind kind) { return action_names[static_cast<std::size_t>(kind)]; }

struct Action {
  ActionKind kind = ActionKind::send;
  std::uint8_t who = 0;    ///< participant, or channel (Wiring)
  std::uint16_t what = 0;  ///< method (its index), peer, position in a channel, or forged word
  constexpr auto operator<=>(const Action&) const = default;
};

constexpr bool is_network(ActionKind kind) { return kind < ActionKind::call; }
constexpr bool is_fault(ActionKind kind) { return kind >= ActionKind::lose; }

}  // namespace takt::explore
