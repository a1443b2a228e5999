// SPDX-License-Identifier: Apache-2.0
// What the script does to Programs: how many calls and faults come before a group has come to rest again, and what
// follows for assumptions about Programs.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>

#include "analysis/bounds.hpp"

namespace takt::analysis {

/// Calls and faults that hit a Program between two rests.
struct EventsInARow {
  std::size_t calls = 0;
  std::size_t faults = 0;  ///< crashes and restarts of participants
};

/// The most that come in a row: one begins before the group has come to rest after the one before, as its bounds say.
/// All that the scenario has, if it has no bound.
EventsInARow events_in_a_row(const scenario::Resolved& resolved, const Bounds& bounds, std::size_t program);

/// Nothing but crashes of nodes of the Program's tree loses frames of its stream. One that forwards them cuts others
/// off besides.
bool is_lost_with_its_ends(const scenario::Resolved& resolved, std::size_t program, const StreamBound& stream);

/// Of a Program with roles: messages of one kind that a member publishes in the whole run besides the cyclic ones, at
/// most; nothing if that is too much to be of use. Each node that announces itself, and each call, join, leave, crash
/// and restart in its tree, moves nobody more often than a leaver moves a spare: the group halts, its roles are bound
/// anew, one after the other if spares are moved, and it may start again. Silence that nothing of that explains is left
/// to assess_programs.
std::optional<std::int64_t> most_changes_of_roles(const scenario::Resolved& resolved, std::size_t program);

/// Discharges what the scenario and the bounds of reactions say about Programs, or says why it stays open.
void assess_programs(const scenario::Resolved& resolved, Bounds& bounds);

}  // namespace takt::analysis
