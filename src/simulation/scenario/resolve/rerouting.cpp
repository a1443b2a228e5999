// SPDX-License-Identifier: Apache-2.0
#include "scenario/resolve/rerouting.hpp"

#include <algorithm>
#include <map>
#include <set>
#include <tuple>
#include <utility>

#include "scenario/topology/filtering.hpp"
#include "scenario/topology/routing.hpp"

namespace takt::scenario {
namespace {

/// (node, vlan, address) -> ports.
using Tables = std::map<std::tuple<std::uint32_t, models::VlanId, std::uint32_t>, std::set<std::uint16_t>>;

Topology without_links(const Topology& topology, const std::vector<std::uint32_t>& reasons_down) {
  Topology left = topology;
  left.links.clear();
  for (std::vector<Neighbour>& neighbours : left.neighbours) neighbours.clear();
  for (std::size_t l = 0; l < topology.links.size(); ++l) {
    if (reasons_down[l] > 0) continue;
    const models::LinkPlan& link = topology.links[l];
    left.links.push_back(link);
    left.neighbours[link.a.node.value].push_back({link.b.node.value, link.a.port, link.b.port});
    left.neighbours[link.b.node.value].push_back({link.a.node.value, link.b.port, link.a.port});
  }
  return left;
}

/// The entries of all streams that find their own path; `before` are those in force, which a receiver keeps that is cut
/// off.
Tables tables_of(const Resolved& r, const Topology& topology, const Tables& before) {
  Router router(topology);
  Tables tables;
  for (const ResolvedStream& stream : r.streams) {
    const models::StreamPlan& plan = r.plan.streams[stream.index.value];
    if (!stream.finds_its_way) continue;
    bool cut_off = false;
    for (const models::NodeIndex listener : plan.listeners) {
      const auto path = plan.listeners.size() == 1 ? router.to_host(plan.talker.value, listener.value)
                                                   : router.from_host(plan.talker.value, listener.value);
      cut_off |= !path;
      if (path)
        for_each_entry(topology, *path, [&](std::size_t at, std::uint16_t port) {
          tables[{(*path)[at], plan.vlan, plan.destination.value}].insert(port);
        });
    }
    if (!cut_off) continue;
    for (const auto& [key, ports] : before)
      if (std::get<1>(key) == plan.vlan && std::get<2>(key) == plan.destination.value) tables.try_emplace(key, ports);
  }
  return tables;
}

}  // namespace

std::vector<ResolvedAction> plan_rerouting(const Resolved& r, const std::vector<Outage>& outages, Duration delay) {
  std::vector<ResolvedAction> actions;
  std::vector<std::uint32_t> reasons_down(r.plan.links.size(), 0);
  Tables tables;
  for (const models::FilteringPlan& entry : r.plan.filtering)
    tables[{entry.node.value, entry.vlan, entry.address.value}].insert(entry.port);
  for (std::size_t i = 0; i < outages.size(); ++i) {
    for (const std::uint32_t link : outages[i].links) reasons_down[link] += outages[i].up ? -1u : 1u;
    if (i + 1 < outages.size() && outages[i + 1].at == outages[i].at) continue;
    const Tables next = tables_of(r, without_links(r.topology, reasons_down), tables);
    ResolvedRoutes routes;
    for (const auto& [key, ports] : next) {
      const auto& [node, vlan, address] = key;
      const auto known = tables.find(key);
      if (known != tables.end() && known->second == ports) continue;
      routes.entries.push_back(
          {models::NodeIndex{node}, vlan, models::AddressIndex{address}, {ports.begin(), ports.end()}});
    }
    for (const ResolvedRoutes::Entry& entry : routes.entries)
      tables[{entry.node.value, entry.vlan, entry.address.value}] = {entry.ports.begin(), entry.ports.end()};
    if (!routes.entries.empty()) actions.push_back({outages[i].at.plus_saturated(delay), std::move(routes)});
  }
  return actions;
}

}  // namespace takt::scenario
