// SPDX-License-Identifier: Apache-2.0
// The threads of one run.
#pragma once

#include <cstdint>

#include "cli/commands.hpp"
#include "scenario/division/division.hpp"

namespace takt::cli {

inline constexpr std::uint32_t most_threads = 64;

void add_threads_option(Command command, std::uint32_t& threads);

/// How the run is divided; says on standard error why it has fewer threads than asked for.
scenario::Division division_for(const scenario::Resolved& resolved, unsigned threads);

}  // namespace takt::cli
