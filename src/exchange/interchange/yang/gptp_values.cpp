// SPDX-License-Identifier: Apache-2.0
// Numbers of PTP messages and the identities that the module of IEEE 1588 gives them.
#include <algorithm>
#include <span>

#include "interchange/yang/gptp.hpp"
#include "sim/check.hpp"

namespace takt::interchange::yang {
namespace {

// IEEE 1588-2019 tables 4, 5 and 6.
constexpr NamedNumber classes[] = {
    {"cc-primary-sync", 6},
    {"cc-primary-sync-lost", 7},
    {"cc-application-specific-sync", 13},
    {"cc-application-specific-sync-lost", 14},
    {"cc-primary-sync-alternative-a", 52},
    {"cc-application-specific-alternative-a", 58},
    {"cc-primary-sync-alternative-b", 187},
    {"cc-application-specific-alternative-b", 193},
    {"cc-default", 248},
    {"cc-time-receiver-only", 255},
};
constexpr NamedNumber accuracies[] = {
    {"ca-time-accurate-to-1000-fs", 0x17}, {"ca-time-accurate-to-2500-fs", 0x18}, {"ca-time-accurate-to-10-ps", 0x19},
    {"ca-time-accurate-to-25ps", 0x1A},    {"ca-time-accurate-to-100-ps", 0x1B},  {"ca-time-accurate-to-250-ps", 0x1C},
    {"ca-time-accurate-to-1000-ps", 0x1D}, {"ca-time-accurate-to-2500-ps", 0x1E}, {"ca-time-accurate-to-10-ns", 0x1F},
    {"ca-time-accurate-to-25-ns", 0x20},   {"ca-time-accurate-to-100-ns", 0x21},  {"ca-time-accurate-to-250-ns", 0x22},
    {"ca-time-accurate-to-1000-ns", 0x23}, {"ca-time-accurate-to-2500-ns", 0x24}, {"ca-time-accurate-to-10-us", 0x25},
    {"ca-time-accurate-to-25-us", 0x26},   {"ca-time-accurate-to-100-us", 0x27},  {"ca-time-accurate-to-250-us", 0x28},
    {"ca-time-accurate-to-1000-us", 0x29}, {"ca-time-accurate-to-2500-us", 0x2A}, {"ca-time-accurate-to-10-ms", 0x2B},
    {"ca-time-accurate-to-25-ms", 0x2C},   {"ca-time-accurate-to-100-ms", 0x2D},  {"ca-time-accurate-to-250-ms", 0x2E},
    {"ca-time-accurate-to-1-s", 0x2F},     {"ca-time-accurate-to-10-s", 0x30},    {"ca-time-accurate-to-gt-10-s", 0x31},
};
constexpr NamedNumber sources[] = {
    {"atomic-clock", 0x10},     {"gnss", 0x20},  {"terrestrial-radio", 0x30},
    {"serial-time-code", 0x39}, {"ptp", 0x40},   {"ntp", 0x50},
    {"hand-set", 0x60},         {"other", 0x90}, {"internal-oscillator", 0xA0},
};

std::span<const NamedNumber> table_of(std::string_view leaf) {
  if (leaf == "clock-class") return classes;
  if (leaf == "clock-accuracy") return accuracies;
  TAKT_CHECK(leaf == "time-source", "a leaf with a table of identities");
  return sources;
}

}  // namespace

std::optional<std::string_view> identity_of_number(std::string_view leaf, std::uint8_t number) {
  const auto table = table_of(leaf);
  const auto found = std::ranges::find(table, number, &NamedNumber::number);
  return found == table.end() ? std::nullopt : std::optional(found->name);
}

std::optional<std::uint8_t> number_of_identity(std::string_view leaf, std::string_view name) {
  if (const std::size_t colon = name.find(':'); colon != std::string_view::npos) name.remove_prefix(colon + 1);
  const auto table = table_of(leaf);
  const auto found = std::ranges::find(table, name, &NamedNumber::name);
  return found == table.end() ? std::nullopt : std::optional(found->number);
}

namespace {
/// numerator / denominator to the nearest whole number, halves away from 0.
std::int64_t nearest(sim::int128 numerator, std::int64_t denominator) {
  const sim::int128 half = denominator / 2;
  return static_cast<std::int64_t>((numerator < 0 ? numerator - half : numerator + half) / denominator);
}
}  // namespace

std::int64_t time_interval(sim::Duration duration) {
  return nearest(static_cast<sim::int128>(duration.ps()) * 65536, 1000);
}

std::string scaled_ns(sim::Duration duration) {
  constexpr std::string_view digits = "0123456789ABCDEF";
  const std::int64_t value = time_interval(duration);
  std::string text;
  for (int octet = 11; octet >= 0; --octet) {
    const auto bits = octet < 8   ? static_cast<std::uint64_t>(value) >> (8 * octet) & 0xFF
                      : value < 0 ? 0xFFU
                                  : 0U;  // the sign goes on
    text += text.empty() ? "" : "-";
    text += digits[bits >> 4];
    text += digits[bits & 0xF];
  }
  return text;
}

std::optional<sim::Duration> duration_of_scaled_ns(std::string_view text) {
  constexpr std::string_view digits = "0123456789ABCDEF";
  if (text.size() != 12 * 3 - 1) return std::nullopt;
  std::uint64_t value = 0;
  unsigned above = 0, sign = 0;  // the four octets above 64 bits repeat the sign
  for (std::size_t octet = 0; octet < 12; ++octet) {
    const std::size_t high = digits.find(text[3 * octet]), low = digits.find(text[3 * octet + 1]);
    if (high == std::string_view::npos || low == std::string_view::npos || (octet < 11 && text[3 * octet + 2] != '-'))
      return std::nullopt;
    const auto bits = static_cast<unsigned>(high << 4 | low);
    if (octet == 0) sign = bits;
    if (octet < 4)
      above |= bits ^ sign;
    else
      value = value << 8 | bits;
  }
  const bool is_negative = value >> 63 != 0;
  if (above != 0 || sign != (is_negative ? 0xFFU : 0U)) return std::nullopt;
  return duration_of_time_interval(static_cast<std::int64_t>(value));
}

namespace {
constexpr std::int64_t least_log = -12;  // 10^12 ps have twelve factors of two
constexpr std::int64_t most_log = 11;    // 2048 s
std::int64_t ps_of_log(std::int64_t exponent) {
  return exponent < 0 ? 1'000'000'000'000 >> -exponent : std::int64_t{1'000'000'000'000} << exponent;
}
}  // namespace

std::optional<std::int8_t> log_of_seconds(sim::Duration duration) {
  if (duration == sim::Duration()) return std::int8_t{-128};
  for (std::int64_t exponent = least_log; exponent <= most_log; ++exponent)
    if (ps_of_log(exponent) == duration.ps()) return static_cast<std::int8_t>(exponent);
  return std::nullopt;
}

std::optional<sim::Duration> duration_of_log(std::int64_t exponent) {
  if (exponent == -128) return sim::Duration();
  if (exponent < least_log || exponent > most_log) return std::nullopt;
  return sim::Duration::from_ps(ps_of_log(exponent));
}

std::optional<sim::Duration> duration_of_time_interval(std::int64_t interval) {
  const sim::int128 hour = static_cast<sim::int128>(3'600'000'000'000) * 65536;  // ns
  if (interval > hour || -static_cast<sim::int128>(interval) > hour) return std::nullopt;
  return sim::Duration::from_ps(nearest(static_cast<sim::int128>(interval) * 1000, 65536));
}

}  // namespace takt::interchange::yang
