// What the fields of a Program mean together, as far as no network is needed to tell.
#pragma once

#include <string>
#include <vector>

#include "json/diagnostics.hpp"
#include "plant/program.hpp"

namespace takt::plant {

/// The master and the slaves, or the master and the roles.
std::vector<std::string> participants_of(const Program& program);

/// Whether its cycle is known, so that other times can be compared with it.
bool has_cycle(const Program& program, const json::Diagnostics& diagnostics);

/// Times within the cycle or beyond it; roles, their names, their skills and what does not go with them. Says nothing that follows from what was refused.
void check_program(const Program& program, json::Diagnostics& diagnostics);

}  // namespace takt::plant
