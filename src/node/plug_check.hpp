// The roles of a node's Programs: checked, and what the node is in them.
#pragma once

#include <optional>

#include "node/config.hpp"

namespace takt::node {

/// Reports what cannot be: as in scenarios, besides roles without candidates.
void check_roles(const Program& program, json::Diagnostics& diagnostics);
/// What the node offers, and to whom: to one Program with roles, which needs some of it.
void check_offers(const Config& config, std::span<const Program> programs, json::Diagnostics& diagnostics);

/// After these checks. Nothing for a Program with slaves. `shape` is the Program's.
std::optional<wire::RoleSettings> roles_at(const Config& config, const Program& program, const wire::ProgramShape& shape);

/// Whether the node may have this role.
bool may_have(const Config& config, const Role& role);

}  // namespace takt::node
