#include "plant/protocol.hpp"

#include <array>
#include <utility>

namespace takt::plant {
namespace {

using uadp::BuiltInType;

constexpr std::array<BuiltInType, 11> built_in_types = {
    BuiltInType::Boolean, BuiltInType::SByte, BuiltInType::Byte,   BuiltInType::Int16, BuiltInType::UInt16, BuiltInType::Int32,
    BuiltInType::UInt32,  BuiltInType::Int64, BuiltInType::UInt64, BuiltInType::Float, BuiltInType::Double};
static_assert(built_in_types.size() == static_cast<std::size_t>(DataType::float64) + 1);

}  // namespace

BuiltInType built_in_type_of(DataType type) { return built_in_types[static_cast<std::size_t>(type)]; }

wire::DataSetShape data_set_shape_of(const ProcessData& data, std::uint8_t from) {
  wire::DataSetShape shape;
  shape.name = data.name;
  shape.from = from;
  for (const auto& [name, field] : data.fields) shape.fields.push_back({name, built_in_type_of(field.type), field.count});
  return shape;
}

wire::PlugShape plug_shape_of(wire::ProgramShape program, std::span<const Role> roles, std::vector<std::string> candidates) {
  wire::PlugShape shape;
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
