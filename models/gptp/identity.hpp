// SPDX-License-Identifier: Apache-2.0
// Who speaks: identities of clocks and ports.
#pragma once

#include <array>
#include <compare>
#include <cstdint>

namespace takt::models::gptp {

/// EUI-64 of a PTP instance; compared octet by octet, the smaller wins.
struct ClockIdentity {
  std::array<std::uint8_t, 8> octets{};

  /// Of a number: the identity with these 64 bits, most significant first.
  static constexpr ClockIdentity from_number(std::uint64_t number) {
    ClockIdentity identity;
    for (std::size_t i = 0; i < 8; ++i) identity.octets[i] = static_cast<std::uint8_t>(number >> (56 - 8 * i));
    return identity;
  }
  /// Of a MAC address (48 bits): FF-FE goes into its middle.
  static constexpr ClockIdentity from_mac(std::uint64_t mac) {
    return from_number((mac >> 24 & 0xFFFFFF) << 40 | std::uint64_t{0xFFFE} << 24 | (mac & 0xFFFFFF));
  }
  auto operator<=>(const ClockIdentity&) const = default;
};

struct PortIdentity {
  ClockIdentity clock;
  std::uint16_t port = 0;  // 1 ...; 0 stands for the instance itself
  /// Whoever hears it (targetPortIdentity of Signaling).
  static constexpr PortIdentity all() { return {ClockIdentity::from_number(0xFFFF'FFFF'FFFF'FFFF), 0xFFFF}; }
  auto operator<=>(const PortIdentity&) const = default;
};

}  // namespace takt::models::gptp
