// SPDX-License-Identifier: Apache-2.0
// Octets as text.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "sim/octets.hpp"

namespace takt::security::test {

inline std::vector<std::byte> from_hex(std::string_view hex) {
  std::vector<std::byte> octets;
  for (std::size_t i = 0; i + 1 < hex.size(); i += 2)
    octets.push_back(static_cast<std::byte>(std::stoi(std::string(hex.substr(i, 2)), nullptr, 16)));
  return octets;
}

inline std::string to_hex(sim::OctetSpan octets) {
  std::string hex;
  for (const std::byte octet : octets) {
    hex += "0123456789abcdef"[std::to_integer<unsigned>(octet) >> 4];
    hex += "0123456789abcdef"[std::to_integer<unsigned>(octet) & 15];
  }
  return hex;
}

}  // namespace takt::security::test
