// One Program of a node's file: checked, and what it is on the network.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "node/config.hpp"

namespace takt::node {

/// The nodes: the master and the slaves, or the candidates.
std::vector<std::string> nodes_of(const Program& program);

/// Participants, times and messages, which have to fit into a frame. With a mistake the shape
/// is not to be used.
wire::ProgramShape checked_shape(const Program& program, std::uint16_t first_publisher_id, json::Diagnostics& diagnostics);

/// `index` is the participant that the node of this name is; without format.
wire::EndpointSettings endpoint_settings(const Program& program, std::uint8_t index, const std::string& node, std::uint8_t priority);

/// Which of the Programs is nested in which: refuses what is none (as in scenarios: an unknown outer Program, a master that is no slave of
/// it, a circle, two inner Programs at one slave, the handshake of the paper).
void check_nesting(std::span<const Program> programs, json::Diagnostics& diagnostics);

}  // namespace takt::node
