// SPDX-License-Identifier: Apache-2.0
#include "json/quantity.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <numeric>
#include <vector>

#include "json/node.hpp"
#include "json/page_text.hpp"
#include "json/suggest.hpp"

namespace takt::json {

namespace {

constexpr std::int64_t k = 1'000;
constexpr std::int64_t m = k * k;
constexpr std::int64_t g = k * m;
constexpr std::int64_t t = k * g;
constexpr std::int64_t ki = 1'024;
constexpr std::int64_t mi = ki * ki;
constexpr std::int64_t gi = ki * mi;

constexpr Unit duration_units[] = {
    {"ps", 1}, {"ns", k}, {"us", m}, {"ms", g}, {"s", t}, {"min", 60 * t, true}, {"h", 3600 * t, true}};
constexpr Unit data_rate_units[] = {{"bps", 1}, {"kbps", k}, {"Mbps", m}, {"Gbps", g}, {"Tbps", t}};
constexpr Unit length_units[] = {{"mm", 1}, {"cm", 10}, {"m", k}, {"km", m}};
constexpr Unit octets_units[] = {{"B", 1},          {"kB", k, true, true}, {"KiB", ki, true}, {"MB", m, true},
                                 {"MiB", mi, true}, {"GB", g, true},       {"GiB", gi, true}};
constexpr Unit frequency_offset_units[] = {{"ppt", 1}, {"ppb", k}, {"ppm", m}, {"%", 10 * g, true, true}};
constexpr Unit frequency_drift_units[] = {{"ppt/s", 1}, {"ppb/s", k}, {"ppm/s", m}};
constexpr Unit probability_units[] = {{"%", Probability::certain / 100}, {"", Probability::certain}};

constexpr sim::int128 max_int64 = std::numeric_limits<std::int64_t>::max();
constexpr std::size_t most_digits = 38;  // 10^38 < 2^127
constexpr std::size_t longest_text = 100;

sim::uint128 power_of_ten(std::size_t exponent) {
  sim::uint128 power = 1;
  for (; exponent > 0; --exponent) power *= 10;
  return power;
}

/// +-digits / 10^decimals, and what follows in the text.
struct Decimal {
  bool is_number = false;
  bool is_negative = false;
  std::string digits;  ///< without leading zeros; empty is zero
  long decimals = 0;
  std::string_view number_text;
  std::string_view unit;
};

/// Reads as much of the text as is a decimal number.
Decimal read_decimal(std::string_view text, bool may_have_plus, bool may_have_exponent) {
  Decimal decimal;
  std::size_t i = 0;
  const auto at = [text](std::size_t index) { return index < text.size() ? text[index] : '\0'; };
  if (at(0) == '-' || (at(0) == '+' && may_have_plus)) decimal.is_negative = at(i++) == '-';
  if (!is_digit(at(i))) return decimal;
  for (; is_digit(at(i)); ++i) decimal.digits += at(i);
  if (at(i) == '.') {
    if (!is_digit(at(++i))) return decimal;
    for (; is_digit(at(i)); ++i, ++decimal.decimals) decimal.digits += at(i);
  }
  if (may_have_exponent && (at(i) == 'e' || at(i) == 'E')) {
    ++i;
    const bool is_minus = at(i) == '-';
    if (at(i) == '-' || at(i) == '+') ++i;
    if (!is_digit(at(i))) return decimal;
    long exponent = 0;
    for (; is_digit(at(i)); ++i) exponent = std::min(exponent * 10 + (at(i) - '0'), 100'000L);
    decimal.decimals += is_minus ? exponent : -exponent;
  }
  decimal.is_number = true;
  decimal.number_text = text.substr(0, i);
  decimal.unit = text.substr(i);

  decimal.digits.erase(0, decimal.digits.find_first_not_of('0'));
  while (!decimal.digits.empty() && decimal.digits.back() == '0') {
    decimal.digits.pop_back();
    --decimal.decimals;
  }
  return decimal;
}

std::string unit_list(const Dimension& dimension) {
  std::string list;
  for (const Unit& unit : dimension.units)
    if (!unit.name.empty()) list += (list.empty() ? "" : ", ") + std::string(unit.name);
  return list;
}

std::string such_as(const Dimension& dimension) {
  return fmt::format("{} such as \"{}\"", dimension.what, dimension.example);
}

bool starts_exponent(std::string_view unit) {
  return unit.size() > 1 && (unit[0] == 'e' || unit[0] == 'E') &&
         (is_digit(unit[1]) || unit[1] == '-' || unit[1] == '+');
}

/// The micro sign and the Greek letter mean u.
std::string with_ascii_micro(std::string_view unit) {
  if (unit.starts_with("\xC2\xB5") || unit.starts_with("\xCE\xBC")) return "u" + std::string(unit.substr(2));
  return std::string(unit);
}

Reason unknown_unit(const Dimension& dimension, const Decimal& decimal) {
  std::vector<std::string_view> names;
  for (const Unit& unit : dimension.units)
    if (!unit.name.empty()) names.push_back(unit.name);
  const std::string nearest = suggest(with_ascii_micro(decimal.unit), names);
  return {fmt::format("unknown unit {}", quote(decimal.unit)), "one of the units " + unit_list(dimension),
          nearest.empty() ? "" : std::string(decimal.number_text) + nearest};
}

Reason too_large(const Dimension& dimension) {
  return {"too large", fmt::format("{} of at most {}", dimension.what, quantity_text(dimension, dimension.max)), ""};
}

Reason too_fine(const Dimension& dimension) {
  return {"too fine", fmt::format("{} in whole multiples of {}", dimension.what, dimension.resolution), ""};
}

/// digits / 10^decimals * factor, if that is a whole number.
Parsed<sim::int128> scale(const Dimension& dimension, const Decimal& decimal, std::int64_t factor) {
  if (decimal.digits.empty()) return sim::int128{0};
  // The digits end in no zero, so that more decimals than the factor has tens cannot come out whole.
  if (decimal.decimals > static_cast<long>(most_digits)) return too_fine(dimension);
  if (decimal.digits.size() > most_digits || decimal.decimals < -static_cast<long>(most_digits)) {
    const bool is_long_fraction = decimal.decimals > 18;  // no unit is larger than 10^18
    return is_long_fraction ? too_fine(dimension) : too_large(dimension);
  }
  sim::uint128 mantissa = 0;
  for (const char digit : decimal.digits) mantissa = mantissa * 10 + static_cast<unsigned>(digit - '0');

  auto numerator = static_cast<sim::uint128>(factor);
  if (decimal.decimals > 0) {
    // mantissa * numerator / denominator is whole if what the numerator leaves of the denominator divides the mantissa.
    sim::uint128 denominator = power_of_ten(static_cast<std::size_t>(decimal.decimals));
    sim::uint128 a = denominator, b = numerator;
    while (b != 0) a = std::exchange(b, a % b);
    denominator /= a;
    numerator /= a;
    if (mantissa % denominator != 0) return too_fine(dimension);
    mantissa /= denominator;
  }
  const auto limit = static_cast<sim::uint128>(dimension.max);
  for (long zeros = -decimal.decimals; zeros > 0; --zeros) {
    if (mantissa > limit / 10) return too_large(dimension);
    mantissa *= 10;
  }
  if (mantissa > limit / numerator) return too_large(dimension);
  const auto value = static_cast<sim::int128>(mantissa * numerator);
  return decimal.is_negative ? -value : value;
}

template <class T, class Make>
Parsed<T> convert(const Parsed<sim::int128>& raw, Make make) {
  if (!raw) return raw.reason();
  return make(*raw);
}

}  // namespace

const Dimension duration_dimension{"a duration", "200us", "1ps", "0s", duration_units, max_int64, false};
const Dimension data_rate_dimension{
    "a data rate", "1Gbps", "1bps", "0bps", data_rate_units, std::numeric_limits<std::uint64_t>::max(), false};
const Dimension length_dimension{"a length", "10m", "1mm", "0m", length_units, max_int64, false};
const Dimension octets_dimension{"a size", "1000B", "1B", "0B", octets_units, std::numeric_limits<std::uint32_t>::max(),
                                 false};
const Dimension frequency_offset_dimension{"a frequency offset",   "50ppm",   "1ppt", "0ppm",
                                           frequency_offset_units, max_int64, true};
const Dimension frequency_drift_dimension{"a frequency drift",   "1ppm/s",  "1ppt/s", "0ppm/s",
                                          frequency_drift_units, max_int64, true};
const Dimension probability_dimension{"a probability from 0 to 1", "0.1%", "1e-18", "0", probability_units,
                                      Probability::certain,        false};

Parsed<sim::int128> parse_quantity(const Dimension& dimension, std::string_view text, Sign sign) {
  const bool is_plain_number_allowed = &dimension == &probability_dimension;
  if (text.empty()) return Reason{"an empty text", such_as(dimension), ""};
  if (text.size() > longest_text) return Reason{"a text that is too long", such_as(dimension), ""};
  const Decimal decimal = read_decimal(text, dimension.is_signed, is_plain_number_allowed);
  if (text.find_first_of(" \t") != std::string_view::npos) {
    std::string joined(text);
    std::erase_if(joined, [](char c) { return c == ' ' || c == '\t'; });
    const bool is_good = static_cast<bool>(parse_quantity(dimension, joined, sign));
    return Reason{"a space in a quantity", such_as(dimension), is_good ? joined : ""};
  }
  if (!decimal.is_number) return Reason{"not a number with a unit", such_as(dimension), ""};
  if (decimal.is_negative && sign == Sign::not_negative && !dimension.is_signed)
    return Reason{"negative", fmt::format("{} that is not negative", dimension.what), ""};
  const auto unit = std::ranges::find(dimension.units, decimal.unit, &Unit::name);
  if (unit != dimension.units.end()) return scale(dimension, decimal, unit->factor);
  if (decimal.unit.empty()) return Reason{"missing unit", "one of the units " + unit_list(dimension), ""};
  if (starts_exponent(decimal.unit)) return Reason{"an exponent in a quantity", such_as(dimension), ""};
  return unknown_unit(dimension, decimal);
}

std::string quantity_text(const Dimension& dimension, sim::int128 value) {
  if (value == 0) return std::string(dimension.zero);
  if (&dimension == &probability_dimension) return to_text(Probability{static_cast<std::int64_t>(value)});
  const auto magnitude = value < 0 ? -static_cast<sim::uint128>(value) : static_cast<sim::uint128>(value);
  const Unit* best = &dimension.units.front();
  for (const Unit& unit : dimension.units) {
    const auto factor = static_cast<sim::uint128>(unit.factor);
    if (!unit.never_shown && magnitude >= factor && (!unit.only_whole || magnitude % factor == 0)) best = &unit;
  }
  const auto factor = static_cast<sim::uint128>(best->factor);
  std::string text = (value < 0 ? "-" : "") + to_text(static_cast<sim::int128>(magnitude / factor));
  sim::uint128 rest = magnitude % factor;
  if (rest != 0) text += '.';
  for (; rest != 0; rest %= factor) {
    rest *= 10;
    text += static_cast<char>('0' + static_cast<int>(rest / factor));
  }
  return text.append(best->name);
}

std::string quantity_pattern(const Dimension& dimension, Sign sign) {
  std::string pattern = dimension.is_signed ? "^[+-]?" : sign == Sign::any ? "^-?" : "^";
  pattern += "[0-9]+(\\.[0-9]+)?";
  if (&dimension == &probability_dimension) return pattern + "([eE][+-]?[0-9]+)?%?$";
  pattern += '(';
  for (const Unit& unit : dimension.units) {
    if (&unit != &dimension.units.front()) pattern += '|';
    pattern += unit.name;
  }
  return pattern + ")$";
}

Parsed<sim::Duration> parse_duration(std::string_view text, Sign sign) {
  return convert<sim::Duration>(parse_quantity(duration_dimension, text, sign),
                                [](sim::int128 raw) { return sim::Duration::from_ps(static_cast<std::int64_t>(raw)); });
}
Parsed<sim::DataRate> parse_data_rate(std::string_view text) {
  return convert<sim::DataRate>(parse_quantity(data_rate_dimension, text, Sign::not_negative),
                                [](sim::int128 raw) { return sim::DataRate{static_cast<std::uint64_t>(raw)}; });
}
Parsed<sim::Length> parse_length(std::string_view text) {
  return convert<sim::Length>(parse_quantity(length_dimension, text, Sign::not_negative),
                              [](sim::int128 raw) { return sim::Length{static_cast<std::int64_t>(raw)}; });
}
Parsed<sim::Octets> parse_octets(std::string_view text) {
  return convert<sim::Octets>(parse_quantity(octets_dimension, text, Sign::not_negative),
                              [](sim::int128 raw) { return sim::Octets{static_cast<std::uint32_t>(raw)}; });
}
Parsed<sim::FrequencyOffset> parse_frequency_offset(std::string_view text) {
  return convert<sim::FrequencyOffset>(
      parse_quantity(frequency_offset_dimension, text, Sign::any),
      [](sim::int128 raw) { return sim::FrequencyOffset{static_cast<std::int64_t>(raw)}; });
}
Parsed<FrequencyDrift> parse_frequency_drift(std::string_view text) {
  return convert<FrequencyDrift>(parse_quantity(frequency_drift_dimension, text, Sign::any),
                                 [](sim::int128 raw) { return FrequencyDrift{static_cast<std::int64_t>(raw)}; });
}
Parsed<Probability> parse_probability(std::string_view text) {
  return convert<Probability>(parse_quantity(probability_dimension, text, Sign::not_negative),
                              [](sim::int128 raw) { return Probability{static_cast<std::int64_t>(raw)}; });
}

std::string to_text(sim::Duration value) { return quantity_text(duration_dimension, value.ps()); }
std::string to_page_text(sim::Duration value) {
  std::string text = to_text(value);
  text.insert(text.find_last_of("0123456789.") + 1, " ");
  return text;
}
std::string to_text(sim::DataRate value) {
  return quantity_text(data_rate_dimension, static_cast<sim::int128>(value.bits_per_second));
}
std::string to_text(sim::Length value) { return quantity_text(length_dimension, value.millimetres); }
std::string to_text(sim::Octets value) { return quantity_text(octets_dimension, value.count); }
std::string to_text(sim::FrequencyOffset value) {
  return quantity_text(frequency_offset_dimension, value.parts_per_trillion);
}
std::string to_text(FrequencyDrift value) {
  return quantity_text(frequency_drift_dimension, value.parts_per_trillion_per_second);
}

std::string to_text(Probability value) {
  constexpr std::size_t most_decimals = 6;  // beyond that with an exponent
  if (value.parts_per_quintillion == 0) return "0";
  if (value.parts_per_quintillion == Probability::certain) return "1";
  std::string digits = std::to_string(value.parts_per_quintillion);
  std::size_t decimals = 18;
  for (; digits.back() == '0'; --decimals) digits.pop_back();
  if (decimals > most_decimals) return fmt::format("{}e-{}", digits, decimals);
  return "0." + std::string(decimals - digits.size(), '0') + digits;
}

}  // namespace takt::json
