// What a Program of a scenario is on the network.
#pragma once

#include "scenario/resolve/resolved.hpp"
#include "wire/program_shape.hpp"

namespace takt::scenario {

wire::ProgramShape shape_of(const ResolvedProgram& program);

}  // namespace takt::scenario
