// SPDX-License-Identifier: Apache-2.0
#include "plant/protocol.hpp"

#include <algorithm>
#include <array>
#include <utility>

#include "plant/program_check.hpp"
#include "sim/check.hpp"
#include "wire/program_node.hpp"

namespace takt::plant {
namespace {

using uadp::BuiltInType;

constexpr std::array<BuiltInType, 11> built_in_types = {BuiltInType::Boolean, BuiltInType::SByte,  BuiltInType::Byte,
                                                        BuiltInType::Int16,   BuiltInType::UInt16, BuiltInType::Int32,
                                                        BuiltInType::UInt32,  BuiltInType::Int64,  BuiltInType::UInt64,
                                                        BuiltInType::Float,   BuiltInType::Double};
static_assert(built_in_types.size() == static_cast<std::size_t>(DataType::float64) + 1);
constexpr std::array<BuiltInType, 4> types_beyond_numbers = {BuiltInType::String, BuiltInType::DateTime,
                                                             BuiltInType::Guid, BuiltInType::ByteString};
static_assert(built_in_types.size() + types_beyond_numbers.size() ==
              static_cast<std::size_t>(TopicType::byte_string) + 1);

}  // namespace

BuiltInType built_in_type_of(DataType type) { return built_in_types[static_cast<std::size_t>(type)]; }

BuiltInType built_in_type_of(TopicType type) {
  const auto number = static_cast<std::size_t>(type);
  return number < built_in_types.size() ? built_in_types[number] : types_beyond_numbers[number - built_in_types.size()];
}

TopicType topic_type_of(BuiltInType type) {
  std::size_t number = 0;
  while (number <= static_cast<std::size_t>(TopicType::byte_string) &&
         built_in_type_of(static_cast<TopicType>(number)) != type)
    ++number;
  TAKT_CHECK(number <= static_cast<std::size_t>(TopicType::byte_string), "a type that fields of topics have");
  return static_cast<TopicType>(number);
}

std::uint32_t field_octets_of(const ProcessData& data) {
  std::uint32_t octets = 0;
  for (const auto& [name, field] : data.fields)
    octets += static_cast<std::uint32_t>(uadp::fixed_octets(built_in_type_of(field.type))) * field.count;
  return octets;
}

Duration receive_timeout_of(const Program& program) { return program.receive_timeout.value_or(program.cycle * 10); }

Duration announce_every_of(const Program& program) {
  return program.announce_every.value_or(program.cycle * wire::cycles_of_announcement);
}

wire::ProgramShape shape_of(const Program& program, std::uint16_t first_publisher_id) {
  wire::ProgramShape shape;
  shape.name = program.name;
  shape.variant = program.variant;
  shape.participants = participants_of(program);
  shape.first_publisher_id = first_publisher_id;
  for (const ProcessData& data : program.process_data) {
    wire::DataSetShape& made = shape.data_sets.emplace_back();
    made.name = data.name;
    made.from =
        static_cast<std::uint8_t>(std::ranges::find(shape.participants, data.from) - shape.participants.begin());
    for (const auto& [name, field] : data.fields)
      made.fields.push_back({name, built_in_type_of(field.type), field.count});
  }
  return shape;
}

wire::EndpointSettings endpoint_settings(const Program& program, std::uint8_t participant) {
  const std::vector<std::string> participants = participants_of(program);
  wire::EndpointSettings settings;
  settings.handshake.variant = program.variant;
  settings.handshake.index = participant;
  settings.handshake.role = participant == 0 ? handshake::Role::master : handshake::Role::slave;
  settings.handshake.slaves = static_cast<std::uint8_t>(participants.size() - 1);
  settings.handshake.subscription = program.subscription;
  settings.cycle = program.cycle;
  settings.offset = phase_of(program, participants[participant]);
  settings.receive_timeout = receive_timeout_of(program);
  settings.initialisation = program.initialisation;
  settings.publish_on_change = program.publish == Publish::on_change;
  settings.priority = program.pcp;
  return settings;
}

wire::RoleShape role_shape_of(wire::ProgramShape program, std::span<const Role> roles,
                              std::vector<std::string> candidates) {
  wire::RoleShape shape;
  shape.program = std::move(program);
  for (const Role& role : roles) shape.skills.push_back(handshake::skill_id(role.skill));
  shape.candidates = std::move(candidates);
  return shape;
}

std::vector<handshake::SkillId> skill_ids_of(std::span<const std::string> skills) {
  std::vector<handshake::SkillId> ids;
  for (const std::string& skill : skills) ids.push_back(handshake::skill_id(skill));
  return ids;
}

}  // namespace takt::plant
