// SPDX-License-Identifier: Apache-2.0
// Well-formed UTF-8 (Unicode, table 3-7).
#pragma once

#include <cstddef>
#include <string_view>

namespace takt::json {

/// The octets of the character at the start of a text, 1 to 4; 0 if the text is empty or starts with no whole
/// character.
constexpr std::size_t character_length(std::string_view text) {
  const auto octet = [text](std::size_t i) { return i < text.size() ? static_cast<unsigned char>(text[i]) : 0U; };
  const auto continues = [&octet](std::size_t i) { return (octet(i) & 0xC0U) == 0x80U; };
  const unsigned first = octet(0);
  if (text.empty()) return 0;
  if (first < 0x80) return 1;
  if (first >= 0xC2 && first <= 0xDF && continues(1)) return 2;
  const bool is_overlong = (first == 0xE0 && octet(1) < 0xA0) || (first == 0xF0 && octet(1) < 0x90);
  const bool is_beyond =
      (first == 0xED && octet(1) > 0x9F) || (first == 0xF4 && octet(1) > 0x8F);  // surrogates, U+10FFFF
  if (is_overlong || is_beyond) return 0;
  if (first >= 0xE0 && first <= 0xEF && continues(1) && continues(2)) return 3;
  return first >= 0xF0 && first <= 0xF4 && continues(1) && continues(2) && continues(3) ? 4 : 0;
}

/// The start of a text, of at most so many octets, that cuts no character in two.
constexpr std::string_view first_octets(std::string_view text, std::size_t most) {
  if (text.size() <= most) return text;
  std::size_t length = most;
  while (length > 0 && (static_cast<unsigned char>(text[length]) & 0xC0U) == 0x80U) --length;
  return text.substr(0, length);
}

}  // namespace takt::json
