// SPDX-License-Identifier: Apache-2.0
// What a stranger may say as one of the group: one word of any content, with any sequence number (the fault `forge`).
//
// The contents are abstract where only their relation to the group's own counts: numbers stand around the present one
// and at both ends of the window in which numbers are compared, runs and incarnations are the present ones and a
// foreign one.
#pragma once

#include <vector>

#include "explore/model/query.hpp"
#include "handshake/word.hpp"

namespace takt::explore {

/// A word on the network.
struct Letter {
  handshake::Word word;
  bool ahead = false;  ///< its sequence number is so far ahead that the next true words look older
  constexpr bool operator==(const Letter&) const = default;
};

/// The sequence numbers that stand for all (README.md, "The network").
inline constexpr std::uint16_t overtaken_sequence = 0;
inline constexpr std::uint16_t usual_sequence = 1;
inline constexpr std::uint16_t sequence_ahead = 2;

/// All that a stranger may say as the participant who says `said` now, in an order that depends on nothing else. Words
/// that nobody can take for one of the group are not among them.
std::vector<Letter> forgeries(const handshake::Word& said, std::size_t slaves);

/// More than `forgeries` ever returns.
inline constexpr std::size_t most_forgeries = 3000;

}  // namespace takt::explore
