// SPDX-License-Identifier: Apache-2.0
// What the fields of a Program mean together, as far as no network is needed to tell.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "json/diagnostics.hpp"
#include "plant/program.hpp"

namespace takt::plant {

/// The master and the slaves, or the master and the roles.
std::vector<std::string> participants_of(const Program& program);

/// The master and the slaves, or the master and the candidates that it names.
std::vector<std::string> nodes_of(const Program& program);

/// Whether a node has that name, where what was refused can be known. A file that must be right in itself knows no
/// others.
using MayBeNode = std::function<bool(std::string_view)>;
/// The participant of that name. If there is none, that is told, unless it follows from what was refused.
std::optional<std::uint8_t> participant_of(const Program& program, const std::string& name, const json::Place& place,
                                           const MayBeNode& may_be_node, json::Diagnostics& diagnostics);
/// Whether a name that no participant has may be right once all that was refused is.
bool may_be_participant(const Program& program, std::string_view name, const MayBeNode& may_be_node,
                        const json::Diagnostics& diagnostics);

/// Whether its cycle is known, so that other times can be compared with it.
bool has_cycle(const Program& program, const json::Diagnostics& diagnostics);

/// Times within the cycle or beyond it; roles, their names, their skills and what does not go with them. Says nothing
/// that follows from what was refused.
void check_program(const Program& program, json::Diagnostics& diagnostics);

/// Who is in it, whom phases and data sets name, and whether each data set fits into a message of so many octets; after
/// the nodes were looked up.
void check_members(const Program& program, std::uint32_t most_octets, const MayBeNode& may_be_node,
                   json::Diagnostics& diagnostics);

/// Refuses nesting that is none: an unknown outer Program, a master that is no slave of it, a circle, two inner
/// Programs at one slave, roles, the handshake of the paper. `is_complete`: all Programs could be read.
void check_nesting(std::span<const Program> programs, bool is_complete, json::Diagnostics& diagnostics);

}  // namespace takt::plant
