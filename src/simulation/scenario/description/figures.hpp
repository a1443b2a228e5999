// SPDX-License-Identifier: Apache-2.0
// The words with which requirements and studies say a figure of a result.
#pragma once

#include <cstdint>

#include "json/fields.hpp"

namespace takt::scenario {

/// What is taken if a figure has several values.
enum class Take : std::uint8_t { max, min, mean, sum, count };

const json::Enumeration& describe(json::Type<Take>);

}  // namespace takt::scenario
