// SPDX-License-Identifier: Apache-2.0
#include "scenario/division/blocks.hpp"

#include <algorithm>
#include <cmath>

#include "scenario/run/clock_monitor.hpp"
#include "scenario/topology/node_sets.hpp"

namespace takt::scenario {
namespace {

constexpr double most_octets_of_looks = 1e9;

const models::PortConfig& config_of(const models::NetworkPlan& plan, const models::LinkPlan::End& end) {
  return plan.port_configs[end.port_config.value_or(plan.nodes[end.node.value].port_config)];
}

/// The nodes with Programs, applications and gateways: their monitors see them all.
std::vector<std::uint32_t> watched_nodes(const Resolved& resolved) {
  std::vector<std::uint32_t> nodes;
  for (const ResolvedProgram& program : resolved.programs)
    for (const ResolvedMember& member : program.members) nodes.push_back(member.node.value);
  for (const ResolvedApplication& application : resolved.applications) nodes.push_back(application.node.value);
  return nodes;
}

}  // namespace

Blocks blocks_of(const Resolved& resolved) {
  const models::NetworkPlan& plan = resolved.plan;
  const std::size_t nodes = plan.nodes.size();
  NodeSets sets(nodes);
  std::vector<std::uint32_t> cables(nodes, 0);
  std::vector<bool> cuts_through(nodes, false);
  for (const models::LinkPlan& link : plan.links)
    for (const models::LinkPlan::End& end : {link.a, link.b}) {
      ++cables[end.node.value];
      if (config_of(plan, end).cut_through != 0) cuts_through[end.node.value] = true;
    }
  for (const models::LinkPlan& link : plan.links) {
    const std::uint32_t a = link.a.node.value, b = link.b.node.value;
    const bool cuts = config_of(plan, link.a).preemption.has_value() || config_of(plan, link.b).preemption.has_value();
    // A host alone is nothing to a thread: it would only shorten promises.
    const bool is_drop_cable =
        (cables[a] == 1 && !plan.nodes[a].forwards()) || (cables[b] == 1 && !plan.nodes[b].forwards());
    if (link.may_fail || cuts || cuts_through[a] || cuts_through[b] || is_drop_cable) sets.unite(a, b);
  }
  const std::vector<std::uint32_t> watched = watched_nodes(resolved);
  for (const std::uint32_t node : watched) sets.unite(watched.front(), node);

  Blocks blocks;
  std::vector<std::uint32_t> number(nodes, 0xFFFF'FFFF);
  for (std::uint32_t n = 0; n < nodes; ++n) {
    std::uint32_t& block = number[sets.root(n)];
    if (block == 0xFFFF'FFFF) block = blocks.count++;
    blocks.of_node.push_back(block);
  }
  if (!watched.empty()) blocks.home = blocks.of_node[watched.front()];
  return blocks;
}

std::string why_whole(const Resolved& resolved) {
  const std::optional<Duration> every = look_every(resolved);
  if (!every) return {};
  // What clocks in different parts have shown is put together at the end.
  const auto nodes = static_cast<double>(resolved.plan.nodes.size());
  const double looks = static_cast<double>(resolved.scenario.duration.ps()) / static_cast<double>(every->ps());
  if (const double octets = nodes * looks * static_cast<double>(ClockMonitor::octets_of_a_look);
      octets > most_octets_of_looks)
    return "looks at its clocks would take " + std::to_string(std::llround(octets / 1e6)) +
           " MB until they are put together: \"report_every\" is short for so long a run";
  return {};
}

}  // namespace takt::scenario
