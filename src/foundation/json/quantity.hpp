// SPDX-License-Identifier: Apache-2.0
// Quantities as people write them, "200us" or "2.5Gbps", to exact integers of takt's units and back.
//
// A quantity is decimal digits, an optional fraction and a unit, without space or exponent. It is read exactly or not
// at all: a fraction finer than the unit that takt counts in is refused, never rounded.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>

#include "sim/time.hpp"
#include "sim/units.hpp"

namespace takt::json {

constexpr bool is_digit(char c) { return c >= '0' && c <= '9'; }

/// A probability in parts per 10^18, 0 to 1. Exact for every decimal that people write, down to bit error rates.
struct Probability {
  static constexpr std::int64_t certain = 1'000'000'000'000'000'000;
  std::int64_t parts_per_quintillion = 0;
  constexpr auto operator<=>(const Probability&) const = default;
  constexpr double as_double() const {
    return static_cast<double>(parts_per_quintillion) / static_cast<double>(certain);
  }
};

/// A change of frequency offset in parts per 10^12 a second ("1ppm/s" = 1'000'000).
struct FrequencyDrift {
  std::int64_t parts_per_trillion_per_second = 0;
  constexpr auto operator<=>(const FrequencyDrift&) const = default;
};

/// Why a text is not a quantity: phrases for a diagnostic.
struct Reason {
  std::string message;     ///< "unknown unit", "missing unit", "not a number", "too large", "negative", "too fine"
  std::string expected;    ///< "one of ps, ns, us, ms, s, min, h"
  std::string suggestion;  ///< a text to try, may be empty
};

/// A value or the reason why there is none.
template <class T>
class Parsed {
 public:
  Parsed(T value) : value_(std::move(value)) {}          // NOLINT: both are meant to convert
  Parsed(Reason reason) : reason_(std::move(reason)) {}  // NOLINT
  explicit operator bool() const { return value_.has_value(); }
  const T& operator*() const { return *value_; }
  const Reason& reason() const { return reason_; }

 private:
  std::optional<T> value_;
  Reason reason_;
};

enum class Sign : std::uint8_t { not_negative, any };

/// ps ns us ms s min h
Parsed<sim::Duration> parse_duration(std::string_view text, Sign sign = Sign::not_negative);
/// bps kbps Mbps Gbps Tbps
Parsed<sim::DataRate> parse_data_rate(std::string_view text);
/// mm cm m km
Parsed<sim::Length> parse_length(std::string_view text);
/// B kB MB GB KiB MiB GiB, up to 2^32-1 octets
Parsed<sim::Octets> parse_octets(std::string_view text);
/// ppt ppb ppm %, with or without sign
Parsed<sim::FrequencyOffset> parse_frequency_offset(std::string_view text);
/// ppt/s ppb/s ppm/s, with or without sign
Parsed<FrequencyDrift> parse_frequency_drift(std::string_view text);
/// "0.1%", or a plain number from 0 to 1, which may have an exponent ("1e-9")
Parsed<Probability> parse_probability(std::string_view text);

/// The shortest of the exact spellings: the largest decimal unit that is not above the value ("1.000125ms"); min and h
/// only for whole ones; sizes in B, or in a binary or million unit of which they are a whole multiple.
std::string to_text(sim::Duration value);
std::string to_text(sim::DataRate value);
std::string to_text(sim::Length value);
std::string to_text(sim::Octets value);
std::string to_text(sim::FrequencyOffset value);
std::string to_text(FrequencyDrift value);
std::string to_text(Probability value);  ///< a JSON number, "0.001" or "1e-12"

/// One kind of quantity as a table, for code that treats all of them alike (see fields.hpp).
struct Unit {
  std::string_view name;
  std::int64_t factor;       ///< in the unit that takt counts in
  bool only_whole = false;   ///< to_text() uses it for whole multiples only
  bool never_shown = false;  ///< to_text() does not use it
};

struct Dimension {
  std::string_view what;        ///< "a duration"
  std::string_view example;     ///< "200us"
  std::string_view resolution;  ///< what takt counts in: "1ps"
  std::string_view zero;        ///< how nothing is written: "0s"
  std::span<const Unit> units;  ///< ascending
  sim::int128 max;              ///< in the unit that takt counts in; the negative limit is -max
  bool is_signed;               ///< may be negative without a field saying so
};

extern const Dimension duration_dimension;
extern const Dimension data_rate_dimension;
extern const Dimension length_dimension;
extern const Dimension octets_dimension;
extern const Dimension frequency_offset_dimension;
extern const Dimension frequency_drift_dimension;
extern const Dimension probability_dimension;

Parsed<sim::int128> parse_quantity(const Dimension& dimension, std::string_view text, Sign sign);
std::string quantity_text(const Dimension& dimension, sim::int128 value);
/// A regular expression (ECMA 262, as in JSON Schema) of all texts that can be this quantity.
std::string quantity_pattern(const Dimension& dimension, Sign sign);

}  // namespace takt::json
