// SPDX-License-Identifier: Apache-2.0
// The states of a participant in the order of time, for who draws them.
#pragma once

#include <string_view>
#include <utility>
#include <vector>

#include "scenario/programs/program_monitor.hpp"

namespace takt::output {

inline constexpr std::string_view dead_state = "dead";

/// From each time on that state; it begins as Halted, which stands there too. Who dies is dead, whatever was recorded
/// at that instant.
std::vector<std::pair<sim::TrueTime, std::string_view>> states_of(const scenario::ProgramMonitor& monitor,
                                                                  std::size_t participant);

}  // namespace takt::output
