// SPDX-License-Identifier: Apache-2.0
// What scripts and faults change while a network runs: clocks, links, nodes, gates, routes.
#include <algorithm>

#include "models/network.hpp"

namespace takt::models {

void Network::step_clock(NodeIndex node, sim::Duration by) { clocks_[node.value]->step(*simulation_, by); }

void Network::set_frequency_offset(NodeIndex node, sim::FrequencyOffset offset) {
  clocks_[node.value]->set_frequency_offset(*simulation_, offset);
}

void Network::set_link(std::uint32_t link, bool up) {
  change_link(link, up);
  cuts_[link] = up ? cuts_[link] - 1 : cuts_[link] + 1;
  refresh_joints();
}

void Network::change_link(std::uint32_t link, bool up) {
  const LinkPlan& plan = plan_.links[link];
  TAKT_CHECK(plan.may_fail, "a link that fails is known to");
  std::uint32_t& reasons = reasons_down_[link];
  const bool was_up = reasons == 0;
  reasons = up ? reasons - 1 : reasons + 1;
  if (was_up == (reasons == 0)) return;
  for (const LinkPlan::End& end : {plan.a, plan.b})
    mutable_ports(end.node)[end.port].set_link_up(*simulation_, reasons == 0);
  for (const LinkPlan::End& end : {plan.a, plan.b})
    if (stations_[end.node.value]) stations_[end.node.value]->set_link(end.port, reasons == 0);
}

void Network::set_node(NodeIndex node, bool up) {
  if (up)
    open_joints(
        [&](const Joint& joint) { return std::find(joint.over.begin(), joint.over.end(), node) != joint.over.end(); });
  for (std::uint32_t l = 0; l < plan_.links.size(); ++l)
    if (plan_.links[l].a.node == node || plan_.links[l].b.node == node) change_link(l, up);
  std::uint32_t& crashes = crashes_[node.value];
  crashes = up ? crashes - 1 : crashes + 1;
  refresh_joints();
  if (crashes != (up ? 0u : 1u)) return;  // it crashed once more, or is not back from another crash
  if (cpus_[node.value] && !up) cpus_[node.value]->crash();
  if (stations_[node.value]) stations_[node.value]->set_up(up);
  if (hosts_[node.value] == nullptr) return;
  hosts_[node.value]->set_up(up);
  if (outputs_[node.value]) outputs_[node.value]->set_up(up);
  for (std::size_t i = 0; i < processes_.size(); ++i) {
    if (host_of_process_[i] != node) continue;
    if (up)
      processes_[i]->restart();
    else
      processes_[i]->crash();
  }
}

void Network::force_gate(NodeIndex node, std::uint16_t port, TrafficClass q, std::optional<bool> open) {
  mutable_ports(node)[port].force_gate(*simulation_, q, open);
}

void Network::reroute(NodeIndex node, VlanId vlan, AddressIndex address, std::span<const std::uint16_t> ports) {
  bridges_[node.value]->filtering_database().assign(vlan, address, ports);
  if (routes_) routes_->forget();
}

ConfigChange Network::request_gates(NodeIndex node, std::uint16_t port, const GateConfig& gates) {
  return mutable_ports(node)[port].request_gates(*simulation_, gates);
}

}  // namespace takt::models
