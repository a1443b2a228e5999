// SPDX-License-Identifier: Apache-2.0
// Sets of traffic classes.
#pragma once

#include <bit>
#include <cstdint>

#include "models/ethernet/frame.hpp"

namespace takt::models {

/// Bit q for class q.
using ClassSet = std::uint8_t;

inline constexpr ClassSet every_class = 0xFF;

constexpr bool contains(ClassSet set, TrafficClass q) { return (set >> q & 1u) != 0; }
constexpr ClassSet only(TrafficClass q) { return static_cast<ClassSet>(1u << q); }
constexpr ClassSet with(ClassSet set, TrafficClass q) { return static_cast<ClassSet>(set | 1u << q); }
constexpr ClassSet without(ClassSet set, TrafficClass q) { return static_cast<ClassSet>(set & ~(1u << q)); }
constexpr bool is_one_class(ClassSet set) { return set != 0 && (set & (set - 1)) == 0; }
/// The most urgent class of a set that is not empty.
constexpr TrafficClass highest_class(ClassSet set) { return static_cast<TrafficClass>(std::bit_width(set) - 1); }

}  // namespace takt::models
