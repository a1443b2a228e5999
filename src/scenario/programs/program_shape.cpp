#include "scenario/programs/program_shape.hpp"

#include "plant/protocol.hpp"

namespace takt::scenario {

wire::ProgramShape shape_of(const ResolvedProgram& program) {
  const Program& description = *program.description;
  wire::ProgramShape shape;
  shape.name = program.name;
  shape.variant = description.variant;
  shape.participants.push_back(description.master);
  shape.participants.insert(shape.participants.end(), description.slaves.begin(), description.slaves.end());
  for (const Role& role : description.roles) shape.participants.push_back(role.name);
  shape.first_publisher_id = program.first_publisher_id;
  for (std::size_t d = 0; d < program.process_data.size(); ++d)
    shape.data_sets.push_back(data_set_shape_of(description.process_data[d], program.process_data[d].from));
  return shape;
}

ProgramFormats formats_of(const ResolvedProgram& program, const Topology& topology) {
  const wire::ProgramShape shape = shape_of(program);
  ProgramFormats formats{std::make_shared<const wire::ProgramFormat>(shape), nullptr};
  if (!program.has_roles()) return formats;
  std::vector<std::string> candidates;
  for (const ResolvedMember& each : program.candidates()) candidates.push_back(topology.nodes[each.node.value].name);
  formats.roles = std::make_shared<const wire::PlugFormat>(plant::plug_shape_of(shape, program.description->roles, std::move(candidates)));
  return formats;
}

}  // namespace takt::scenario
