// SPDX-License-Identifier: Apache-2.0
// "traffic_classes" of a node: how many queues its ports have, and which priority is sent in which (IEEE 802.1Q 8.6.6).
#pragma once

#include <array>
#include <cstdint>

#include "json/fields.hpp"

namespace takt::scenario {

/// Eight classes in the order of Table 8-5 or by number, or fewer by the column of Table 8-5 for so many.
enum class TrafficClasses : std::uint8_t { standard, identity, one, two, three, four, five, six, seven };

/// How many there are, from 1 to 8.
std::uint8_t count_of(TrafficClasses classes);

/// The class of each priority.
std::array<std::uint8_t, 8> class_of_priorities(TrafficClasses classes);

const json::Custom& describe(json::Type<TrafficClasses>);

}  // namespace takt::scenario
