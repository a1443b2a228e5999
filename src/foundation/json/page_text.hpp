// SPDX-License-Identifier: Apache-2.0
// Quantities as pages show them to people; files have to_text() of quantity.hpp.
#pragma once

#include <string>

#include "sim/time.hpp"

namespace takt::json {

/// As to_text() with a space before the unit: "1.000125 ms".
std::string to_page_text(sim::Duration value);

}  // namespace takt::json
