// SPDX-License-Identifier: Apache-2.0
// Expressions of NED and ini files: numbers with units, texts, truth values; no floating point.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <string_view>

#include "sim/time.hpp"

namespace takt::interchange::inet {

enum class Unit : std::uint8_t { none, second, bit_per_second, octet, metre };

struct Value {
  enum class Kind : std::uint8_t { number, text, truth };
  Kind kind = Kind::number;
  sim::int128 amount = 0;  ///< of a number: in 10^-12 of its unit
  Unit unit = Unit::none;
  std::string text;
  bool truth = false;
  std::optional<std::int64_t> whole() const;  ///< of a number without a unit
};

/// What a name stands for; null if it is not known.
using Lookup = std::function<std::optional<Value>(const std::string&)>;

/// Null if it is none, or if something in it is not known.
std::optional<Value> evaluate(std::string_view text, const Lookup& lookup = {});

}  // namespace takt::interchange::inet
