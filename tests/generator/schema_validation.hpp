// SPDX-License-Identifier: Apache-2.0
// An independent validator's word on a scenario (valijson, behind a header of its own since it is heavy).
#pragma once

#include <string>

namespace takt::generator {

/// What the schema refuses; "" if nothing.
std::string refused_by_schema(const std::string& text);

}  // namespace takt::generator
