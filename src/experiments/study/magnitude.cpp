// SPDX-License-Identifier: Apache-2.0
#include "study/magnitude.hpp"

#include <fmt/format.h>

#include <array>
#include <charconv>
#include <cmath>

namespace takt::study {
namespace {

struct Base {
  const json::Dimension* dimension;
  std::string_view unit;
  double raw_units;  // in one of these; dividing by a power of ten gives the double that the decimal text means
};

// Probabilities have no entry: they are plain numbers, or percentages, which read as frequency offsets do.
const std::array<Base, 6>& bases() {
  static const std::array<Base, 6> all = {{
      {&json::duration_dimension, "s", 1e12},
      {&json::data_rate_dimension, "bps", 1},
      {&json::length_dimension, "m", 1e3},
      {&json::octets_dimension, "B", 1},
      {&json::frequency_offset_dimension, "ppm", 1e6},
      {&json::frequency_drift_dimension, "ppm/s", 1e6},
  }};
  return all;
}

const Base* base_of(const json::Dimension* dimension) {
  for (const Base& base : bases())
    if (base.dimension == dimension) return &base;
  return nullptr;
}

std::optional<Magnitude> plain_number(std::string_view text) {
  Magnitude magnitude;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), magnitude.number);
  if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(magnitude.number)) return std::nullopt;
  magnitude.is_integer = magnitude.number == std::floor(magnitude.number) && std::abs(magnitude.number) < 9e15;
  if (magnitude.is_integer) magnitude.raw = static_cast<std::int64_t>(magnitude.number);
  return magnitude;
}

struct Prefix {
  double factor;
  std::string_view name;
};

}  // namespace

std::optional<Magnitude> magnitude_of(std::string_view text) {
  if (const auto plain = plain_number(text)) return plain;
  for (const Base& base : bases())
    if (const auto raw = json::parse_quantity(*base.dimension, text,
                                              base.dimension->is_signed ? json::Sign::any : json::Sign::not_negative))
      return Magnitude{base.dimension, *raw, true, static_cast<double>(*raw) / base.raw_units};
  return std::nullopt;
}

std::optional<Magnitude> magnitude_of(const json::Node& value) {
  if (value.kind != json::Kind::number && value.kind != json::Kind::string) return std::nullopt;
  return magnitude_of(value.text);
}

std::string_view base_unit(const json::Dimension* dimension) {
  const Base* const base = base_of(dimension);
  return base == nullptr ? "" : base->unit;
}

double number_of(const json::Dimension* dimension, sim::int128 raw) {
  const Base* const base = base_of(dimension);
  return static_cast<double>(raw) / (base == nullptr ? 1 : base->raw_units);
}

json::Node node_of(const json::Dimension* dimension, sim::int128 raw) {
  return dimension == nullptr ? json::Node::of_integer(raw)
                              : json::Node::of_string(json::quantity_text(*dimension, raw));
}

std::string short_number(double value) { return fmt::format("{:.6g}", value == 0 ? 0.0 : value); }

std::string with_unit(double value, std::string_view unit) {
  static constexpr Prefix of_seconds[] = {{1, "s"}, {1e-3, "ms"}, {1e-6, "us"}, {1e-9, "ns"}, {1e-12, "ps"}};
  static constexpr Prefix of_bits[] = {{1e9, "Gbps"}, {1e6, "Mbps"}, {1e3, "kbps"}, {1, "bps"}};
  if (unit.empty()) return short_number(value);
  if (value != 0 && unit == "s") {
    for (const Prefix& prefix : of_seconds)
      if (std::abs(value) >= prefix.factor * 0.9999999)
        return fmt::format("{:.5g} {}", value / prefix.factor, prefix.name);
  }
  if (value != 0 && unit == "bps") {
    for (const Prefix& prefix : of_bits)
      if (std::abs(value) >= prefix.factor) return fmt::format("{:.5g} {}", value / prefix.factor, prefix.name);
  }
  return fmt::format("{} {}", short_number(value), unit);
}

}  // namespace takt::study
