// SPDX-License-Identifier: Apache-2.0
// The redundancy tag (IEEE 802.1CB clause 7.8): six octets after the VLAN tag, before the frame's own EtherType.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "models/ethernet/sizes.hpp"

namespace takt::models {

using SequenceNumber = std::uint16_t;  ///< of a compound stream; 65535 is followed by 0
inline constexpr std::uint16_t r_tag_ether_type = 0xF1C1;

/// EtherType, 16 reserved bits (0), sequence number; most significant octet first.
constexpr std::array<std::byte, r_tag.count> encode_r_tag(SequenceNumber sequence) {
  return {std::byte{r_tag_ether_type >> 8},      std::byte{r_tag_ether_type & 0xFF},     std::byte{0}, std::byte{0},
          static_cast<std::byte>(sequence >> 8), static_cast<std::byte>(sequence & 0xFF)};
}

/// The sequence number if the octets begin with an R-TAG. Reserved bits are ignored on reception.
constexpr std::optional<SequenceNumber> decode_r_tag(std::span<const std::byte> octets) {
  if (octets.size() < r_tag.count) return std::nullopt;
  const auto word = [&](std::size_t at) {
    return static_cast<std::uint16_t>(std::to_integer<unsigned>(octets[at]) << 8 |
                                      std::to_integer<unsigned>(octets[at + 1]));
  };
  if (word(0) != r_tag_ether_type) return std::nullopt;
  return word(4);
}

}  // namespace takt::models
