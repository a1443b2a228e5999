// SPDX-License-Identifier: Apache-2.0
// What a Program of a scenario is on the network.
#pragma once

#include <memory>

#include "scenario/resolved/resolved.hpp"
#include "wire/role_format.hpp"

namespace takt::scenario {

/// The messages of a program; those of roles only if it has some.
struct ProgramFormats {
  std::shared_ptr<const wire::ProgramFormat> program;
  std::shared_ptr<const wire::RoleFormat> roles;
};
ProgramFormats formats_of(const ResolvedProgram& program, const Topology& topology);

}  // namespace takt::scenario
