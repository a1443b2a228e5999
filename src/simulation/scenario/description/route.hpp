// SPDX-License-Identifier: Apache-2.0
// The way of a stream that the file does not name.
#pragma once

#include <cstdint>

#include "json/fields.hpp"

namespace takt::scenario {

enum class Route : std::uint8_t { automatic };
const json::Enumeration& describe(json::Type<Route>);

}  // namespace takt::scenario
