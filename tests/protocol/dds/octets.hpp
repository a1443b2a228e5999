// SPDX-License-Identifier: Apache-2.0
// Octets in tests: from and to hexadecimal digits.
#pragma once

#include <string>
#include <vector>

#include "dds/message/octets.hpp"

namespace takt::dds::test {

/// "0a ff" and "0aff" alike.
inline std::vector<std::byte> octets_of(const std::string& hex) {
  std::vector<std::byte> octets;
  int high = -1;
  for (const char letter : hex) {
    if (letter == ' ') continue;
    const int digit = letter <= '9' ? letter - '0' : (letter | 0x20) - 'a' + 10;
    if (high >= 0) octets.push_back(static_cast<std::byte>(16 * high + digit));
    high = high >= 0 ? -1 : digit;
  }
  return octets;
}

inline std::string hex_of(Octets octets) {
  std::string text;
  for (const std::byte octet : octets) {
    constexpr const char* digits = "0123456789abcdef";
    text += digits[std::to_integer<unsigned>(octet) >> 4];
    text += digits[std::to_integer<unsigned>(octet) & 0xF];
  }
  return text;
}

inline std::vector<std::byte> copy(Octets octets) { return {octets.begin(), octets.end()}; }

}  // namespace takt::dds::test
