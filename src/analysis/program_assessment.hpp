// What the script does to Programs: how many calls and faults come before a group has come to rest again, and what follows for assumptions about Programs.
#pragma once

#include <cstddef>
#include <optional>

#include "analysis/bounds.hpp"

namespace takt::analysis {

/// Calls and faults that hit a Program between two rests.
struct EventsInARow {
  std::size_t calls = 0;
  std::size_t faults = 0;      ///< crashes and restarts of participants
};

/// The most that come in a row: one begins before the group has come to rest after the one before, as its bounds say. All that the scenario has, if it has no bound.
EventsInARow events_in_a_row(const scenario::Resolved& resolved, const Bounds& bounds, std::size_t program);

/// Discharges what the scenario and the bounds of reactions say about Programs, or says why it stays open.
void assess_programs(const scenario::Resolved& resolved, Bounds& bounds);

}  // namespace takt::analysis
