// What a Program of a scenario is on the network.
#pragma once

#include "scenario/resolved.hpp"
#include "wire/program_shape.hpp"

namespace takt::scenario {

uadp::BuiltInType built_in_type_of(DataType type);

wire::ProgramShape shape_of(const ResolvedProgram& program);

}  // namespace takt::scenario
