// SPDX-License-Identifier: Apache-2.0
// Sine in fixed point, the same on every machine.
#pragma once

#include <cstdint>

namespace takt::models {

/// sin(2 pi * turns / 2^64) as a multiple of 2^-62; wrong by less than 2^-58.
std::int64_t fixed_sine(std::uint64_t turns);

}  // namespace takt::models
