// SPDX-License-Identifier: Apache-2.0
// MAC addresses as they are on the wire, derived from the addresses that the network counts.
#pragma once

#include <array>
#include <compare>
#include <cstddef>
#include <cstdint>

#include "models/ethernet/frame.hpp"
#include "sim/check.hpp"

namespace takt::models {

/// A 48-bit MAC address (IEEE 802 clause 8); the octet that is sent first is the most significant one.
struct MacAddress {
  std::uint64_t value = 0;
  constexpr auto operator<=>(const MacAddress&) const = default;

  constexpr bool is_group() const { return (value >> 40 & 1) != 0; }
  constexpr std::array<std::byte, 6> octets() const {
    std::array<std::byte, 6> all{};
    for (std::size_t i = 0; i < 6; ++i) all[i] = static_cast<std::byte>(value >> (40 - 8 * i) & 0xFF);
    return all;
  }
};
inline constexpr MacAddress all_ones_mask{0xFFFF'FFFF'FFFF};

/// The nearest-bridge group address, to which gPTP speaks; no bridge forwards it (IEEE 802.1AS 11.3.4).
inline constexpr AddressIndex gptp_address{0x00FF'FFFF};

/// 02-00-5E-xx-xx-xx for a node, 03-00-5E-xx-xx-xx for a group: locally administered, the index in the last three
/// octets. Addresses below `first_group` (the number of nodes of the network) are those of nodes; an index has at most
/// 24 bits.
constexpr MacAddress mac_address_of(AddressIndex address, std::uint32_t first_group) {
  if (address == gptp_address) return {0x01'80'C2'00'00'0E};
  TAKT_CHECK(address.value < 1u << 24, "an address index fits into three octets");
  const std::uint64_t prefix = address.value < first_group ? 0x02'00'5E : 0x03'00'5E;
  return {prefix << 24 | address.value};
}

}  // namespace takt::models
