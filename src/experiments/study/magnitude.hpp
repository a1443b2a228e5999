// SPDX-License-Identifier: Apache-2.0
// What a text such as "200us", "1Gbps" or "12" is worth as a number, for axes, constraints and limits.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "json/node.hpp"
#include "json/quantity.hpp"

namespace takt::study {

/// A quantity with its kind. `dimension` is null for a plain number.
struct Magnitude {
  const json::Dimension* dimension = nullptr;
  sim::int128 raw = 0;  ///< in the unit in which takt counts; of a plain number, only if is_integer
  bool is_integer = true;
  double number = 0;  ///< in base_unit()
};

/// Reads a number or a quantity; nothing if it is neither.
std::optional<Magnitude> magnitude_of(std::string_view text);
/// Of a JSON number or string; nothing for other values.
std::optional<Magnitude> magnitude_of(const json::Node& value);

/// In which Magnitude::number counts: "s", "bps", "m", "B", "ppm" or "ppm/s"; "" for plain numbers.
std::string_view base_unit(const json::Dimension* dimension);
double number_of(const json::Dimension* dimension, sim::int128 raw);
/// The value as a scenario writes it: an integer, or a text with its unit.
json::Node node_of(const json::Dimension* dimension, sim::int128 raw);

/// Six significant digits, without trailing zeros.
std::string short_number(double value);
/// A number in a base unit as people write it: 0.0002 and "s" are "200 us".
std::string with_unit(double value, std::string_view unit);

}  // namespace takt::study
