#include "scenario/program_shape.hpp"

namespace takt::scenario {

using uadp::BuiltInType;

BuiltInType built_in_type_of(DataType type) {
  switch (type) {
    case DataType::boolean: return BuiltInType::Boolean;
    case DataType::sbyte: return BuiltInType::SByte;
    case DataType::byte: return BuiltInType::Byte;
    case DataType::int16: return BuiltInType::Int16;
    case DataType::uint16: return BuiltInType::UInt16;
    case DataType::int32: return BuiltInType::Int32;
    case DataType::uint32: return BuiltInType::UInt32;
    case DataType::int64: return BuiltInType::Int64;
    case DataType::uint64: return BuiltInType::UInt64;
    case DataType::float32: return BuiltInType::Float;
    case DataType::float64: return BuiltInType::Double;
  }
  return BuiltInType::Null;
}

wire::ProgramShape shape_of(const ResolvedProgram& program) {
  const Program& description = *program.description;
  wire::ProgramShape shape;
  shape.name = program.name;
  shape.variant = description.variant == Variant::robust ? handshake::Variant::Robust : handshake::Variant::Paper;
  shape.participants.push_back(description.master);
  shape.participants.insert(shape.participants.end(), description.slaves.begin(), description.slaves.end());
  for (const Role& role : description.roles) shape.participants.push_back(role.name);
  shape.first_publisher_id = program.first_publisher_id;
  for (std::size_t d = 0; d < program.process_data.size(); ++d) {
    wire::DataSetShape data_set;
    data_set.name = program.process_data[d].name;
    data_set.from = program.process_data[d].from;
    for (const auto& [name, field] : description.process_data[d].fields) data_set.fields.push_back({name, built_in_type_of(field.type), field.count});
    shape.data_sets.push_back(std::move(data_set));
  }
  return shape;
}

}  // namespace takt::scenario
