// SPDX-License-Identifier: Apache-2.0
// Where messages go (DDSI-RTPS 8.2.6, 9.3.2, 9.6.1.1): addresses, and the ports that follow from the domain and the
// participant.
#pragma once

#include <array>
#include <compare>
#include <cstdint>
#include <string>

namespace takt::dds {

enum class LocatorKind : std::int32_t {
  invalid = -1,
  reserved = 0,
  udp_v4 = 1,
  udp_v6 = 2,
  tcp_v4 = 4,             ///< vendors'; refused as a way to send
  tcp_v6 = 8,             ///< vendors'; refused as a way to send
  ethernet = 0x02000000,  ///< DDS-TSN 1.0 beta
};

struct Locator {
  LocatorKind kind = LocatorKind::invalid;
  std::uint32_t port = 0;
  std::array<std::uint8_t, 16> address{};  ///< IPv4 in the last four octets

  static constexpr Locator udp_v4(std::array<std::uint8_t, 4> ip, std::uint32_t port) {
    Locator locator{LocatorKind::udp_v4, port, {}};
    for (std::size_t i = 0; i < 4; ++i) locator.address[12 + i] = ip[i];
    return locator;
  }
  /// `ip` as a number, 10.0.0.1 being 0x0A000001.
  static constexpr Locator udp_v4(std::uint32_t ip, std::uint32_t port) {
    return udp_v4({static_cast<std::uint8_t>(ip >> 24), static_cast<std::uint8_t>(ip >> 16),
                   static_cast<std::uint8_t>(ip >> 8), static_cast<std::uint8_t>(ip)},
                  port);
  }
  constexpr auto operator<=>(const Locator&) const = default;
  constexpr bool is_udp_v4() const { return kind == LocatorKind::udp_v4; }
  constexpr std::uint32_t ip_v4() const {
    return std::uint32_t{address[12]} << 24 | std::uint32_t{address[13]} << 16 | std::uint32_t{address[14]} << 8 |
           address[15];
  }
  constexpr bool is_multicast() const { return is_udp_v4() && ip_v4() >> 28 == 0xE; }
};

/// "udp/10.0.0.1:7400".
std::string to_string(const Locator& locator);

/// The group of SPDP, 239.255.0.1 (9.6.1.4.1).
inline constexpr std::uint32_t discovery_group = 0xEFFF0001;

/// PB, DG, PG and d0 to d3 of 9.6.1.1 with their defaults.
struct PortMapping {
  std::uint32_t base = 7400;
  std::uint32_t domain_gain = 250;
  std::uint32_t participant_gain = 2;
  std::uint32_t multicast_metatraffic = 0;  ///< d0
  std::uint32_t unicast_metatraffic = 10;   ///< d1
  std::uint32_t multicast_user = 1;         ///< d2
  std::uint32_t unicast_user = 11;          ///< d3
  bool operator==(const PortMapping&) const = default;
};

/// The four ports of one participant.
struct Ports {
  std::uint16_t multicast_metatraffic = 0;
  std::uint16_t unicast_metatraffic = 0;
  std::uint16_t multicast_user = 0;
  std::uint16_t unicast_user = 0;
  bool operator==(const Ports&) const = default;
};

/// Why there are no such ports: a port is above 65535, or a participant's would be those of the next domain. Empty if
/// there are.
std::string port_problem(std::uint32_t domain, std::uint32_t participant, const PortMapping& mapping = {});

/// TAKT_CHECKs that port_problem() is empty.
Ports ports_of(std::uint32_t domain, std::uint32_t participant, const PortMapping& mapping = {});

}  // namespace takt::dds
