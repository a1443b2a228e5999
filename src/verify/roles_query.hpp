// The roles of a scenario's Program as a query to the explorer.
#pragma once

#include <optional>
#include <string>

#include "explore/model/query.hpp"
#include "scenario/resolve/resolved.hpp"

namespace takt::verify {

/// Sets roles and candidates; what cannot be explored, or nothing.
std::optional<std::string> set_roles(const scenario::ResolvedProgram& program, explore::Query& query);

}  // namespace takt::verify
