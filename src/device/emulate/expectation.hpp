// SPDX-License-Identifier: Apache-2.0
// What the simulated run of a scenario with roles has come to when an action is due. Real nodes take their time, above
// all on a busy machine, and which node gets a role depends on who is there: so the emulation acts when its groups are
// where the simulated ones were.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "emulate/comparison.hpp"
#include "emulate/plan.hpp"
#include "handshake/word.hpp"
#include "scenario/programs/program_monitor.hpp"
#include "scenario/resolved/resolved.hpp"

namespace takt::emulate {

/// A group with roles at one instant.
struct GroupState {
  std::vector<handshake::PublishedState>
      states;                      ///< by participant: the master, then the roles; of one that nobody has Halted
  std::vector<std::string> nodes;  ///< by role; "" is nobody
  std::vector<bool> present;       ///< by candidate: the master has heard of it, and may give it a role
  bool operator==(const GroupState&) const = default;
};

struct Expectation {
  /// Just before each action of the plan and, last, at the end; by Program. Nothing for a Program without roles, or
  /// with one in which something has changed within its last ten cycles: that is nothing to wait for.
  std::vector<std::vector<std::optional<GroupState>>> before;
  /// By Program: its candidates in the order in which they got their first role, then the others.
  std::vector<std::vector<std::uint8_t>> order;
};

/// Runs the simulation. Nothing if no Program has roles.
std::optional<Expectation> expectation_of(const scenario::Resolved& resolved, const Plan& plan);

/// What the simulated run has shown of a Program.
History history_of(const scenario::ProgramMonitor& monitor);

/// From a master's status, as its node tells it; the states are all Halted but its own. Nothing if it is no such
/// status.
std::optional<GroupState> group_of_status(const std::string& status, const scenario::ResolvedProgram& program);
/// The state in a node's status.
std::optional<handshake::PublishedState> state_of_status(const std::string& status);

/// How the two differ, in a few words; "" if they do not.
std::string difference(const GroupState& expected, const GroupState& found, const scenario::Resolved& resolved,
                       std::uint32_t program);

}  // namespace takt::emulate
