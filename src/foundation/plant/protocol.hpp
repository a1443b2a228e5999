// SPDX-License-Identifier: Apache-2.0
// From the words of files to the values of protocol code.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "handshake/binder.hpp"
#include "handshake/participant.hpp"
#include "plant/program.hpp"
#include "plant/role.hpp"
#include "plant/uadp.hpp"
#include "wire/program_endpoint.hpp"
#include "wire/program_shape.hpp"
#include "wire/role_format.hpp"

namespace takt::plant {

uadp::BuiltInType built_in_type_of(DataType type);
uadp::BuiltInType built_in_type_of(TopicType type);
/// The other way, of a type that fields of topics may have.
TopicType topic_type_of(uadp::BuiltInType type);

/// Octets of all values of a data set.
std::uint32_t field_octets_of(const ProcessData& data);
/// MessageReceiveTimeout.
Duration receive_timeout_of(const Program& program);
/// How often what has or gives roles announces itself.
Duration announce_every_of(const Program& program);

/// Of a Program that was checked.
wire::ProgramShape shape_of(const Program& program, std::uint16_t first_publisher_id);
/// Of a participant; without format and incarnation.
wire::EndpointSettings endpoint_settings(const Program& program, std::uint8_t participant);

/// Of a group with roles, which are the participants of `program` behind the master.
wire::RoleShape role_shape_of(wire::ProgramShape program, std::span<const Role> roles,
                              std::vector<std::string> candidates);
/// The skills that a node offers.
std::vector<handshake::SkillId> skill_ids_of(std::span<const std::string> skills);

}  // namespace takt::plant
