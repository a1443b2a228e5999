// SPDX-License-Identifier: Apache-2.0
#include "json/printable.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "json/utf8.hpp"

namespace takt::json {
namespace {

/// The code point of one whole character.
unsigned code_point(std::string_view character) {
  const auto octet = [character](std::size_t i) {
    return static_cast<unsigned>(static_cast<unsigned char>(character[i]));
  };
  switch (character.size()) {
    case 1:
      return octet(0);
    case 2:
      return (octet(0) & 0x1FU) << 6U | (octet(1) & 0x3FU);
    case 3:
      return (octet(0) & 0x0FU) << 12U | (octet(1) & 0x3FU) << 6U | (octet(2) & 0x3FU);
    default:
      return (octet(0) & 0x07U) << 18U | (octet(1) & 0x3FU) << 12U | (octet(2) & 0x3FU) << 6U | (octet(3) & 0x3FU);
  }
}

bool is_control(unsigned point) {
  const auto in = [point](unsigned first, unsigned last) { return point >= first && point <= last; };
  return point < 0x20 || in(0x7F, 0x9F) || in(0x2028, 0x202E) || in(0x2066, 0x2069);
}

template <class Keep>
std::string shown(std::string_view text, Keep keep) {
  std::string result;
  result.reserve(text.size());
  while (!text.empty()) {
    const std::size_t length = character_length(text);
    if (length == 0) {
      result += fmt::format("\\x{:02x}", static_cast<unsigned char>(text.front()));
      text.remove_prefix(1);
      continue;
    }
    const unsigned point = code_point(text.substr(0, length));
    if (is_control(point) && !keep(point))
      result += fmt::format("\\u{:04x}", point);
    else
      result += text.substr(0, length);
    text.remove_prefix(length);
  }
  return result;
}

}  // namespace

std::size_t find_control(std::string_view text) {
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t length = character_length(text.substr(at));
    if (length == 0 || is_control(code_point(text.substr(at, length)))) return at;
    at += length;
  }
  return std::string_view::npos;
}

std::string printable(std::string_view text) {
  return shown(text, [](unsigned) { return false; });
}

std::string printable_page(std::string_view page) {
  return shown(page, [](unsigned point) { return point == '\n' || point == '\t'; });
}

std::string csv_field(std::string_view text) {
  if (text.find_first_of(",\"\r\n") == std::string_view::npos) return std::string(text);
  std::string quoted = "\"";
  for (const char c : text) quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
  return quoted + '"';
}

std::string file_name(std::string_view text) {
  constexpr std::string_view refused = "/\\:*?\"<>|%";
  std::string name;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    const bool leads = i == 0 && (c == '.' || c == '-' || c == '~');
    if (leads || static_cast<unsigned char>(c) < 0x20 || c == 0x7F || refused.find(c) != std::string_view::npos)
      name += fmt::format("%{:02X}", static_cast<unsigned char>(c));
    else
      name += c;
  }
  return name;
}

std::string shell_word(std::string_view text) {
  const bool is_plain = !text.empty() && std::ranges::all_of(text, [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
           std::string_view("_-./:@+,=").find(c) != std::string_view::npos;
  });
  if (is_plain) return std::string(text);
  std::string quoted = "'";
  for (const char c : text) quoted += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return quoted + "'";
}

}  // namespace takt::json
