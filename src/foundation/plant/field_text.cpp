// SPDX-License-Identifier: Apache-2.0
#include "plant/field_text.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <string>
#include <utility>

#include "uadp/value.hpp"

namespace takt::plant {
namespace {

using Values = std::optional<std::vector<std::byte>>;

constexpr std::int64_t ticks_per_second = 10'000'000;
constexpr std::int64_t seconds_from_1601_to_1970 = 11'644'473'600;

std::optional<unsigned> digit(char c, unsigned base) {
  const unsigned value = c >= '0' && c <= '9'   ? static_cast<unsigned>(c - '0')
                         : c >= 'a' && c <= 'f' ? static_cast<unsigned>(c - 'a') + 10
                         : c >= 'A' && c <= 'F' ? static_cast<unsigned>(c - 'A') + 10
                                                : base;
  return value < base ? std::optional(value) : std::nullopt;
}

/// All of the text as a number.
std::optional<unsigned> number(std::string_view text, unsigned base = 10) {
  unsigned value = 0;
  for (const char c : text) {
    const auto next = digit(c, base);
    if (!next) return std::nullopt;
    value = value * base + *next;
  }
  return text.empty() ? std::nullopt : std::optional(value);
}

Values hexadecimal(std::string_view text) {
  if (text.size() % 2 != 0) return std::nullopt;
  std::vector<std::byte> octets;
  for (std::size_t i = 0; i < text.size(); i += 2) {
    const auto octet = number(text.substr(i, 2), 16);
    if (!octet) return std::nullopt;
    octets.push_back(static_cast<std::byte>(*octet));
  }
  return octets;
}

/// 8-4-4-4-12 digits; the first three numbers are little-endian on the wire (OPC 10000-6, 5.2.2.6).
Values guid(std::string_view text) {
  constexpr std::array<std::size_t, 4> hyphens = {8, 13, 18, 23};
  if (text.size() != 36) return std::nullopt;
  std::string digits;
  std::size_t hyphen = 0;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const bool is_hyphen = hyphen < hyphens.size() && i == hyphens[hyphen];
    if (is_hyphen != (text[i] == '-')) return std::nullopt;
    if (is_hyphen)
      ++hyphen;
    else
      digits += text[i];
  }
  Values octets = hexadecimal(digits);
  if (!octets) return std::nullopt;
  for (const auto& [begin, end] : {std::pair(0, 4), std::pair(4, 6), std::pair(6, 8)})
    std::reverse(octets->begin() + begin, octets->begin() + end);
  return octets;
}

/// "2024-01-17T02:26:40Z", with a fraction of a second of up to seven digits.
std::optional<uadp::DateTime> date_time(std::string_view text) {
  constexpr std::string_view form = "....-..-..T..:..:..";
  if (text.size() < form.size() + 1 || text.back() != 'Z') return std::nullopt;
  for (std::size_t i = 0; i < form.size(); ++i)
    if (form[i] == '.' ? !digit(text[i], 10) : text[i] != form[i]) return std::nullopt;
  std::string fraction(text.substr(form.size(), text.size() - form.size() - 1));
  if (!fraction.empty() && (fraction[0] != '.' || fraction.size() < 2 || fraction.size() > 8)) return std::nullopt;
  if (fraction.empty()) fraction = ".";
  fraction.resize(8, '0');
  const auto ticks = number(std::string_view(fraction).substr(1));
  const auto part = [&](std::size_t at, std::size_t length) { return number(text.substr(at, length)).value_or(0); };
  const std::chrono::year_month_day day(std::chrono::year(static_cast<int>(part(0, 4))), std::chrono::month(part(5, 2)),
                                        std::chrono::day(part(8, 2)));
  const unsigned hour = part(11, 2), minute = part(14, 2), second = part(17, 2);
  if (!ticks || !day.ok() || part(0, 4) < 1601 || hour > 23 || minute > 59 || second > 59) return std::nullopt;
  const std::int64_t days = std::chrono::sys_days(day).time_since_epoch().count();
  const std::int64_t seconds = days * 86'400 + hour * 3600 + minute * 60 + second + seconds_from_1601_to_1970;
  return uadp::DateTime{seconds * ticks_per_second + *ticks};
}

std::vector<std::byte> with_length(std::span<const std::byte> octets) {
  std::vector<std::byte> all(4 + octets.size());
  uadp::Writer writer(all);
  uadp::put_length_and_octets(writer, octets);
  return all;
}

}  // namespace

std::string_view spelling_of(TopicType type) {
  switch (type) {
    case TopicType::string:
      return "text";
    case TopicType::date_time:
      return "a time in UTC, from 1601 on, such as \"2024-01-17T02:26:40.5Z\"";
    case TopicType::guid:
      return "a GUID such as \"72962b91-fa75-4ae6-8d28-b404dc7daf63\"";
    case TopicType::byte_string:
      return "two hexadecimal digits for each octet";
    default:
      return {};
  }
}

Values octets_of_text(TopicType type, std::string_view text) {
  if (type == TopicType::string) return with_length(std::as_bytes(std::span(text.data(), text.size())));
  if (type == TopicType::guid) return guid(text);
  if (type == TopicType::byte_string) {
    const Values octets = hexadecimal(text);
    return octets ? Values(with_length(*octets)) : std::nullopt;
  }
  const auto time = type == TopicType::date_time ? date_time(text) : std::nullopt;
  if (!time) return std::nullopt;
  std::vector<std::byte> octets(sizeof time->ticks);
  uadp::store_value(octets.data(), *time);
  return octets;
}

}  // namespace takt::plant
