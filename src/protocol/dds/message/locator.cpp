// SPDX-License-Identifier: Apache-2.0
#include "dds/message/locator.hpp"

#include <algorithm>

#include "sim/check.hpp"

namespace takt::dds {
namespace {

using Wide = std::uint64_t;
constexpr Wide greatest_port = 65535;

/// The ports before they are known to be below 65536, in the order of `Ports`.
std::array<Wide, 4> wide_ports(Wide domain, Wide participant, const PortMapping& mapping) {
  const Wide base = mapping.base + mapping.domain_gain * domain;
  const Wide own = mapping.participant_gain * participant;
  return {base + mapping.multicast_metatraffic, base + mapping.unicast_metatraffic + own, base + mapping.multicast_user,
          base + mapping.unicast_user + own};
}

}  // namespace

std::string to_string(const Locator& locator) {
  const std::string port = ":" + std::to_string(locator.port);
  if (!locator.is_udp_v4()) return "kind " + std::to_string(static_cast<std::int32_t>(locator.kind)) + port;
  std::string text = "udp/";
  for (std::size_t i = 12; i < 16; ++i) text += (i == 12 ? "" : ".") + std::to_string(locator.address[i]);
  return text + port;
}

std::string port_problem(std::uint32_t domain, std::uint32_t participant, const PortMapping& mapping) {
  const std::string who = "domain " + std::to_string(domain) + ", participant " + std::to_string(participant);
  const auto ports = wide_ports(domain, participant, mapping);
  const Wide greatest = *std::max_element(ports.begin(), ports.end());
  if (greatest > greatest_port) return who + ": port " + std::to_string(greatest) + " is above 65535";
  if (greatest >= Wide{mapping.base} + Wide{mapping.domain_gain} * (Wide{domain} + 1))
    return who + ": port " + std::to_string(greatest) + " belongs to domain " + std::to_string(domain + 1);
  return {};
}

Ports ports_of(std::uint32_t domain, std::uint32_t participant, const PortMapping& mapping) {
  TAKT_CHECK(port_problem(domain, participant, mapping).empty(), "ports are asked for where there are some");
  const auto ports = wide_ports(domain, participant, mapping);
  const auto port = [&](std::size_t i) { return static_cast<std::uint16_t>(ports[i]); };
  return {port(0), port(1), port(2), port(3)};
}

}  // namespace takt::dds
