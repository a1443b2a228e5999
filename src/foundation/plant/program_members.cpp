// SPDX-License-Identifier: Apache-2.0
// Special members of large structs, compiled once: copies inline cost each unit that makes one seconds.
#include "plant/program.hpp"

namespace takt::plant {

Program::Program() = default;
Program::Program(const Program&) = default;
Program::Program(Program&&) noexcept = default;
Program& Program::operator=(const Program&) = default;
Program& Program::operator=(Program&&) noexcept = default;
Program::~Program() = default;

}  // namespace takt::plant
