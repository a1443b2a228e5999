// SPDX-License-Identifier: Apache-2.0
#include "dds/message/guid.hpp"

namespace takt::dds {
namespace {

void append_hex(std::string& text, std::uint8_t octet) {
  constexpr const char* digits = "0123456789abcdef";
  text += digits[octet >> 4];
  text += digits[octet & 0xF];
}

}  // namespace

std::string to_string(const GuidPrefix& prefix) {
  std::string text;
  for (std::size_t i = 0; i < prefix.octets.size(); ++i) {
    if (i != 0 && i % 4 == 0) text += '.';
    append_hex(text, prefix.octets[i]);
  }
  return text;
}

std::string to_string(EntityId id) {
  std::string text;
  for (unsigned shift = 32; shift != 0; shift -= 8)
    append_hex(text, static_cast<std::uint8_t>(id.value >> (shift - 8)));
  return text;
}

std::string to_string(const Guid& guid) { return to_string(guid.prefix) + "|" + to_string(guid.entity); }

}  // namespace takt::dds
