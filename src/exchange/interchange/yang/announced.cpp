// SPDX-License-Identifier: Apache-2.0
// What bridges announce of their delays and queues, for the nodes of a scenario.
#include <algorithm>
#include <map>

#include "interchange/yang/device_type.hpp"
#include "interchange/yang/modules.hpp"
#include "scenario/resolve/device_delays.hpp"
#include "scenario/topology/topology.hpp"

namespace takt::interchange::yang {
namespace {

constexpr std::string_view announced[] = {"independent-delays", "independent-delays-cascaded",
                                          "dependent-delays",   "dependent-delays-cascaded",
                                          "phy-latencies",      "supported-resource-pools"};

/// Whether anything of the module IEC/IEEE 60802 has for bridges is there that a node may get.
bool announces(const Data& data) {
  if (data.schema->module == iec_bridge_m && std::ranges::find(announced, data.schema->name) != std::end(announced))
    return true;
  return std::ranges::any_of(data.children, announces);
}

std::vector<scenario::DevicePort> ports_of_node(const scenario::NetworkSection& network, const std::string& name) {
  std::vector<scenario::DevicePort> ports;
  for (const scenario::Link& link : network.links)
    for (const std::string& end : link.ends)
      if (end.substr(0, end.find(':')) == name) ports.push_back({scenario::rate_of(link), link.medium});
  return ports;
}

}  // namespace

void set_announced(const DeviceData& files, scenario::Scenario& scenario, Imported& imported,
                   json::Diagnostics& diagnostics) {
  std::map<std::string, std::vector<const Data*>> by_node;
  for (const auto& [name, data] : files)
    if (announces(*data)) by_node[name].push_back(data);
  for (const auto& [name, data] : by_node) {
    const auto node = std::ranges::find(scenario.network.nodes, name, [](const auto& each) { return each.first; });
    const auto type = device_type_of(data, name, imported, diagnostics);
    if (!type || node == scenario.network.nodes.end()) continue;
    const json::Place place = data.front()->place;
    scenario::NodePorts& ports = scenario::ports_of(node->second);
    if (type->queues) ports.queues = *type->queues;
    if (!type->phys.empty())
      imported.remark(RemarkKind::lost, place,
                      "latencies of PHYs, which act on time stamps: `takt import device` makes a type of them");
    scenario::Relay* const relay = scenario::relay_of(node->second);
    if (relay == nullptr || type->delays.empty()) continue;
    std::optional<scenario::MissingDelay> missing;
    const sim::Octets longest{ports.mtu.value_or(scenario.network.mtu).count + scenario::octets_around_msdu};
    const auto interval = scenario::delays_between(*type, ports_of_node(scenario.network, name), longest, missing);
    if (missing)
      diagnostics.error(place, "a delay that the bridge does not announce",
                        {"none from " + scenario::to_text(missing->from) + " to " + scenario::to_text(missing->to) +
                             " at " + json::quote(name),
                         "delays between all media that the links of the node have"});
    if (interval) scenario::set_delays(*interval, {}, relay->forwarding_delay, relay->forwarding_jitter);
  }
}

}  // namespace takt::interchange::yang
