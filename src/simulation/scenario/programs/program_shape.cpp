// SPDX-License-Identifier: Apache-2.0
#include "scenario/programs/program_shape.hpp"

#include "plant/protocol.hpp"

namespace takt::scenario {

ProgramFormats formats_of(const ResolvedProgram& program, const Topology& topology) {
  const wire::ProgramShape shape = plant::shape_of(*program.description, program.first_publisher_id);
  ProgramFormats formats{std::make_shared<const wire::ProgramFormat>(shape), nullptr};
  if (!program.has_roles()) return formats;
  std::vector<std::string> candidates;
  for (const ResolvedMember& each : program.candidates()) candidates.push_back(topology.nodes[each.node.value].name);
  formats.roles = std::make_shared<const wire::RoleFormat>(
      plant::role_shape_of(shape, program.description->roles, std::move(candidates)));
  return formats;
}

}  // namespace takt::scenario
