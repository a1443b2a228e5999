// SPDX-License-Identifier: Apache-2.0
// The devices of a scenario as those see them who configure them: each port with its interface's name, its neighbour
// and what it is set to.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "interchange/interfaces.hpp"
#include "scenario/resolved/resolved.hpp"

namespace takt::interchange {

struct DevicePort {
  std::uint16_t port = 0;
  std::string interface;   ///< what the table of names says, else see interface_name
  std::uint32_t peer = 0;  ///< node
  std::string peer_name;
  sim::DataRate rate;
  const models::PortConfig* config = nullptr;
};

struct Device {
  std::uint32_t node = 0;
  std::string name;
  models::NodeKind kind = models::NodeKind::host;
  std::vector<DevicePort> ports;  ///< ascending numbers
  const models::IngressConfig* ingress = nullptr;
};

/// All nodes, in the order of the scenario.
std::vector<Device> devices_of(const scenario::Resolved& resolved, const InterfaceNames& interfaces = {});

/// "eth0" of hosts, "swp0" of what forwards, with takt's number of the port.
std::string interface_name(bool forwards, std::uint16_t port);

/// The port of an interface's name: the number at its end; null without one.
std::optional<std::uint16_t> port_of_interface(std::string_view name);

/// Which requirements of the scenario rest on what passes the port, in words: "latency of camera at most 500us".
std::vector<std::string> requirements_at(const scenario::Resolved& resolved, std::uint32_t node, std::uint32_t peer);

/// The classes in which streams wait at that port.
struct ClassUse {
  std::vector<std::string> streams;  ///< names
  sim::Octets longest_frame{0};      ///< DA to FCS
};
std::array<ClassUse, models::traffic_class_count> use_of_port(const scenario::Resolved& resolved, std::uint32_t node,
                                                              std::uint16_t port);

/// "02:00:5e:00:00:01" or with another separator.
std::string mac_text(models::MacAddress address, char between);
models::MacAddress mac_of(const scenario::Resolved& resolved, models::AddressIndex address);

}  // namespace takt::interchange
