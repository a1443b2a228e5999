// SPDX-License-Identifier: Apache-2.0
// How a run on several threads is divided, for people.
#pragma once

#include <string>

#include "scenario/division/division.hpp"

namespace takt::output {

std::string division_report(const scenario::Division& division);

}  // namespace takt::output
