#include "scenario/programs/program_shape.hpp"

#include "vocabulary/protocol.hpp"

namespace takt::scenario {

wire::ProgramShape shape_of(const ResolvedProgram& program) {
  const Program& description = *program.description;
  wire::ProgramShape shape;
  shape.name = program.name;
  shape.variant = variant_of(description.variant);
  shape.participants.push_back(description.master);
  shape.participants.insert(shape.participants.end(), description.slaves.begin(), description.slaves.end());
  for (const Role& role : description.roles) shape.participants.push_back(role.name);
  shape.first_publisher_id = program.first_publisher_id;
  for (std::size_t d = 0; d < program.process_data.size(); ++d)
    shape.data_sets.push_back(data_set_shape_of(description.process_data[d], program.process_data[d].from));
  return shape;
}

}  // namespace takt::scenario
