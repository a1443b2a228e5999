// SPDX-License-Identifier: Apache-2.0
// A number as a value of a type that is known only at run time.
#pragma once

#include <cstddef>
#include <cstdint>

#include "uadp/builtin_type.hpp"

namespace takt::uadp {

/// Writes fixed_octets(type) octets; integers keep the low bits, Boolean the lowest. False for a type that is no
/// number.
bool store_number(BuiltInType type, std::byte* at, std::uint64_t number);

}  // namespace takt::uadp
