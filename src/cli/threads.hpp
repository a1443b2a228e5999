// The threads of one run.
#pragma once

#include <cstdint>
#include <string_view>

#include "cli/commands.hpp"
#include "scenario/division/division.hpp"

namespace takt::cli {

inline constexpr std::uint32_t most_threads = 64;

void add_threads_option(Command command, std::uint32_t& threads);

/// How the run is divided; says on standard error why it has fewer threads than asked for. `why_one`: why it must have one, or nothing.
scenario::Division division_for(const scenario::Resolved& resolved, unsigned threads, std::string_view why_one);

}  // namespace takt::cli
