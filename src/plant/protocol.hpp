// From the words of files to the values of protocol code.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "handshake/binder.hpp"
#include "handshake/participant.hpp"
#include "plant/role.hpp"
#include "plant/program.hpp"
#include "wire/plug_format.hpp"
#include "wire/program_shape.hpp"

namespace takt::plant {

uadp::BuiltInType built_in_type_of(DataType type);

/// `from` is the participant that `data.from` names.
wire::DataSetShape data_set_shape_of(const ProcessData& data, std::uint8_t from);

/// Of a group with roles, which are the participants of `program` behind the master.
wire::PlugShape plug_shape_of(wire::ProgramShape program, std::span<const Role> roles, std::vector<std::string> candidates);
/// The skills that a node offers.
std::vector<handshake::SkillId> skill_ids_of(std::span<const std::string> skills);

}  // namespace takt::plant
