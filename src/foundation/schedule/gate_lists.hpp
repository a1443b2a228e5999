// SPDX-License-Identifier: Apache-2.0
// Gate control lists for a schedule.
//
// While a scheduled frame passes only its class is open; before that the other classes are closed for the guard, and
// the gate of a frame that has not to wait may open with the guard. Where a list would be longer than the port takes,
// the shortest times between windows are given up: the other classes lose them, the schedule does not change.
#pragma once

#include <optional>
#include <string>

#include "schedule/solution.hpp"

namespace takt::schedule {

struct ListLimits {
  std::uint32_t entries = 1'000'000;  ///< at most, besides what each port takes
};

/// Fills `solution.gates` for all links that frames cross. Otherwise says which link cannot have a list and why, and
/// what would do.
std::optional<std::string> make_gate_lists(const Problem& problem, Solution& solution, const ListLimits& limits);

/// The longest list.
std::size_t most_entries(const Solution& solution);

}  // namespace takt::schedule
