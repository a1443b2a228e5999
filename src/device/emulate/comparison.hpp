// SPDX-License-Identifier: Apache-2.0
// The histories of a Program in the simulator and on real nodes, side by side.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "handshake/io.hpp"
#include "program/method.hpp"

namespace takt::emulate {

/// A participant has changed its state. A crash is a change without a transition, to Halted.
struct Change {
  std::int64_t time = 0;  ///< in any unit; the same for all of a history
  std::uint8_t participant = 0;
  handshake::StateChange change;
};

/// A method call of the script that was Good.
struct Call {
  std::int64_t time = 0;
  std::uint8_t participant = 0;
  program::Method method = program::Method::Start;
};

struct History {
  std::vector<Change> changes;  ///< of each participant in their order
  std::vector<Call> calls;
};

struct ParticipantComparison {
  std::string name;
  bool same = false;
  std::vector<handshake::StateChange> simulated;
  std::vector<handshake::StateChange> emulated;
};

struct Comparison {
  std::vector<ParticipantComparison> participants;
  std::size_t orders = 0;             ///< pairs of changes of different participants that must have this order
  std::vector<std::string> violated;  ///< those that have not
  bool is_same() const;
};

/// `names` by participant, the master first. An order is asked of the nodes only where the simulated history has it.
Comparison compare(const History& simulated, const History& emulated, const std::vector<std::string>& names);

}  // namespace takt::emulate
