// SPDX-License-Identifier: Apache-2.0
#include "report/network_figure.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <utility>

namespace takt::report {
namespace {

using Direction = std::pair<std::uint32_t, std::uint16_t>;  // node and port

std::map<Direction, double> loads_of(const scenario::Resolved& resolved, const results::RunResult* result) {
  std::map<Direction, double> loads;
  if (result == nullptr) {
    for (const scenario::PortDemand& port : resolved.ports) loads[{port.node.value, port.port}] = port.share();
    return loads;
  }
  for (const results::PortResult& port : result->ports)
    if (const auto node = resolved.topology.find(port.node)) loads[{*node, port.port}] = port.utilisation;
  return loads;
}

chart::NetworkNode::Kind kind_of(const models::NodePlan& node) {
  if (!node.forwards()) return chart::NetworkNode::Kind::host;
  return node.is_end_station() ? chart::NetworkNode::Kind::station : chart::NetworkNode::Kind::bridge;
}

constexpr const char* name_of(chart::NetworkNode::Kind kind) {
  switch (kind) {
    case chart::NetworkNode::Kind::host:
      return "host";
    case chart::NetworkNode::Kind::bridge:
      return "switch";
    case chart::NetworkNode::Kind::station:
      return "station";
  }
  return "";
}

}  // namespace

chart::NetworkChart network_figure(const scenario::Resolved& resolved, const results::RunResult* result) {
  chart::NetworkChart drawn;
  drawn.title = resolved.scenario.name + ": the network";
  const std::map<Direction, double> loads = loads_of(resolved, result);
  const auto load = [&](const models::LinkPlan::End& end) {
    const auto found = loads.find({end.node.value, end.port});
    return found == loads.end() ? 0.0 : found->second;
  };
  for (const models::NodePlan& node : resolved.plan.nodes) {
    const auto kind = kind_of(node);
    drawn.nodes.push_back({node.name, kind, false, node.name + ", a " + name_of(kind)});
  }
  for (const models::LinkPlan& link : resolved.plan.links) {
    const std::string& a = resolved.plan.nodes[link.a.node.value].name;
    const std::string& b = resolved.plan.nodes[link.b.node.value].name;
    drawn.links.push_back({link.a.node.value, link.b.node.value, std::max(load(link.a), load(link.b)), false,
                           fmt::format("{} to {}: {:.2f} %, back: {:.2f} %; {:g} Mbit/s", a, b, 100 * load(link.a),
                                       100 * load(link.b), static_cast<double>(link.rate.bits_per_second) * 1e-6)});
  }
  const sim::TrueTime end = sim::TrueTime() + (result != nullptr ? result->simulated : resolved.scenario.duration);
  for (const scenario::ResolvedAction& action : resolved.script) {
    if (action.at > end) continue;
    if (const auto* link = std::get_if<scenario::ResolvedLink>(&action.what); link != nullptr && !link->up)
      drawn.links[link->link].has_failed = true;
    if (const auto* node = std::get_if<scenario::ResolvedNode>(&action.what); node != nullptr && !node->up)
      drawn.nodes[node->node.value].has_failed = true;
  }
  return drawn;
}

}  // namespace takt::report
