// SPDX-License-Identifier: Apache-2.0
// The Programs of a node's file: checked, and what the node is in them.
#pragma once

#include <optional>
#include <span>

#include "node/config.hpp"

namespace takt::node {

/// Participants, times, messages, which have to fit into a frame, and what only a simulator does.
void check(const Program& program, json::Diagnostics& diagnostics);
/// What the node offers, and to whom: to one Program with roles, which needs some of it.
void check_offers(const Config& config, std::span<const Program> programs, json::Diagnostics& diagnostics);

/// After these checks. Nothing for a Program with slaves. `shape` is the Program's.
std::optional<wire::RoleSettings> roles_at(const Config& config, const Program& program,
                                           const wire::ProgramShape& shape);

/// Whether the node may have this role.
bool may_have(const Config& config, const Role& role);

}  // namespace takt::node
