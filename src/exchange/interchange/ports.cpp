// SPDX-License-Identifier: Apache-2.0
#include "interchange/ports.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>

#include "json/any.hpp"
#include "scenario/resolve/port_configs.hpp"
#include "scenario/resolve/stream_at_port.hpp"

namespace takt::interchange {

namespace {

/// Parallel links to one neighbour have their names in the order of the ports.
void rename_ports(Device& device, const InterfaceNames& interfaces) {
  const auto found = interfaces.find(device.name);
  if (found == interfaces.end()) return;
  std::vector<std::pair<std::string, std::string>> left = found->second;
  for (DevicePort& port : device.ports) {
    const auto name =
        std::ranges::find(left, port.peer_name, [](const auto& each) -> const std::string& { return each.second; });
    if (name == left.end()) continue;
    port.interface = name->first;
    left.erase(name);
  }
}

}  // namespace

std::vector<Device> devices_of(const scenario::Resolved& resolved, const InterfaceNames& interfaces) {
  std::vector<Device> devices;
  for (std::uint32_t n = 0; n < resolved.plan.nodes.size(); ++n) {
    const models::NodePlan& node = resolved.plan.nodes[n];
    Device device{n, node.name, node.kind, {}, nullptr};
    if (node.ingress) device.ingress = &resolved.plan.ingress_configs[*node.ingress];
    devices.push_back(std::move(device));
  }
  for (const models::LinkPlan& link : resolved.plan.links) {
    for (const auto& [end, peer] : {std::pair(&link.a, &link.b), std::pair(&link.b, &link.a)}) {
      Device& device = devices[end->node.value];
      device.ports.push_back({end->port, interface_name(device.kind != models::NodeKind::host, end->port),
                              peer->node.value, resolved.plan.nodes[peer->node.value].name, link.rate,
                              &scenario::port_config_of(resolved.plan, *end)});
    }
  }
  for (Device& device : devices) {
    std::ranges::sort(device.ports, {}, &DevicePort::port);
    rename_ports(device, interfaces);
  }
  return devices;
}

std::string interface_name(bool forwards, std::uint16_t port) {
  return (forwards ? "swp" : "eth") + std::to_string(port);
}

std::optional<std::uint16_t> port_of_interface(std::string_view name) {
  std::size_t first = name.size();
  while (first > 0 && name[first - 1] >= '0' && name[first - 1] <= '9') --first;
  std::uint16_t port = 0;
  const auto [stop, error] = std::from_chars(name.data() + first, name.data() + name.size(), port);
  if (first == name.size() || error != std::errc() || stop != name.data() + name.size()) return std::nullopt;
  return port;
}

std::vector<std::string> requirements_at(const scenario::Resolved& resolved, std::uint32_t node, std::uint32_t peer) {
  std::vector<std::string> passing;
  for (const scenario::ResolvedStream& stream : resolved.streams) {
    const auto passes = [&](const scenario::Path& path) {
      for (std::size_t i = 0; i + 1 < path.size(); ++i)
        if (path[i] == node && path[i + 1] == peer) return true;
      return false;
    };
    if (std::ranges::any_of(stream.paths, passes)) passing.push_back(resolved.plan.streams[stream.index.value].name);
  }
  const auto is_of_program = [&](const std::string& program) {
    return std::ranges::any_of(passing, [&](const std::string& name) { return name.starts_with(program + "/"); });
  };
  std::vector<std::string> texts;
  for (const scenario::Requirement& requirement : resolved.scenario.require) {
    std::string text;
    if (requirement.stream && std::ranges::find(passing, *requirement.stream) != passing.end()) {
      text = "stream " + *requirement.stream + ":";
      if (requirement.latency) text += " latency at most " + json::to_text(requirement.latency->greatest());
      if (requirement.jitter) text += " jitter at most " + json::to_text(requirement.jitter->greatest());
      if (requirement.dropped) text += " at most " + std::to_string(*requirement.dropped) + " dropped";
      if (requirement.delivered) text += " at least " + std::to_string(*requirement.delivered) + " delivered";
    } else if (requirement.reaction && requirement.program && is_of_program(*requirement.program)) {
      text = "program " + *requirement.program + ": reaction " + std::string(scenario::spelling(*requirement.reaction));
      if (requirement.within && requirement.within->time) text += " within " + json::to_text(*requirement.within->time);
    }
    if (!text.empty() && std::ranges::find(texts, text) == texts.end()) texts.push_back(std::move(text));
  }
  return texts;
}

std::array<ClassUse, models::traffic_class_count> use_of_port(const scenario::Resolved& resolved, std::uint32_t node,
                                                              std::uint16_t port) {
  std::array<ClassUse, models::traffic_class_count> use;
  for (const scenario::StreamAtPort& stream : scenario::streams_at_ports(resolved)) {
    if (stream.node != node || stream.port != port) continue;
    for (models::TrafficClass q = 0; q < models::traffic_class_count; ++q) {
      if (!models::contains(stream.classes, q)) continue;
      const std::string& name = resolved.plan.streams[stream.stream.value].name;
      if (std::ranges::find(use[q].streams, name) == use[q].streams.end()) use[q].streams.push_back(name);
      use[q].longest_frame = std::max(use[q].longest_frame, stream.frame);
    }
  }
  return use;
}

std::string mac_text(models::MacAddress address, char between) {
  std::string text;
  for (const std::byte octet : address.octets())
    text += fmt::format("{}{:02x}", text.empty() ? "" : std::string(1, between), static_cast<unsigned>(octet));
  return text;
}

models::MacAddress mac_of(const scenario::Resolved& resolved, models::AddressIndex address) {
  return models::mac_address_of(address, static_cast<std::uint32_t>(resolved.plan.nodes.size()));
}

}  // namespace takt::interchange
