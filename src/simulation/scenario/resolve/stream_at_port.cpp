// SPDX-License-Identifier: Apache-2.0
#include "scenario/resolve/stream_at_port.hpp"

#include <set>
#include <tuple>

#include "models/egress/cyclic_schedule.hpp"
#include "models/ethernet/sizes.hpp"
#include "scenario/resolve/port_configs.hpp"
#include "scenario/resolve/redundancy.hpp"
#include "scenario/topology/port_table.hpp"

namespace takt::scenario {
namespace {

class Walker {
 public:
  Walker(const Resolved& resolved, const std::function<void(const StreamAtPort&)>& visit)
      : r_(resolved), visit_(visit), ingress_(resolved), configs_(resolved.topology) {
    for (const models::LinkPlan& link : r_.plan.links)
      for (const models::LinkPlan::End* end : {&link.a, &link.b})
        configs_.at(end->node.value, end->port) = &port_config_of(r_.plan, *end);
    for (const ResolvedRedundancy& redundancy : r_.redundancies) redundancies_[redundancy.stream.value] = &redundancy;
  }

  void run() {
    for (const ResolvedStream& stream : r_.streams) {
      const auto redundant = redundancies_.find(stream.index.value);
      seen_.clear();
      for (std::size_t i = 0; i < stream.paths.size(); ++i)
        walk(stream, i, redundant == redundancies_.end() ? nullptr : redundant->second);
    }
  }

 private:
  void walk(const ResolvedStream& stream, std::size_t number, const ResolvedRedundancy* redundancy) {
    const models::StreamPlan& plan = r_.plan.streams[stream.index.value];
    const Path& path = stream.paths[number];
    const Octets msdu = plan.headers + stream.largest_payload;
    const bool is_met_once = stream.paths.size() == 1;
    const std::vector<OnHop> hops = redundancy != nullptr ? on_hops(r_, *redundancy, number) : std::vector<OnHop>();
    OnHop before;
    for (std::size_t i = 0; i + 1 < path.size(); ++i) {
      const std::uint16_t port = port_out(r_.topology, path, i);
      StreamAtPort made{.stream = stream.index, .node = path[i], .port = port, .peer = path[i + 1]};
      models::Frame frame;
      frame.stream = stream.index;
      frame.source = models::AddressIndex{plan.talker.value};
      frame.destination = before.member ? redundancy->members[*before.member].destination : plan.destination;
      frame.vlan = before.member ? redundancy->members[*before.member].vlan : plan.vlan;
      frame.priority = plan.priority.value_or(0);
      frame.tagged = plan.priority.has_value();
      if (i > 0) made.filter = ingress_.filter(path[i], frame);  // what a station sends itself does not come in
      const bool is_policed_tagged =
          before.member && path[i] == redundancy->merge ? redundancy->description->keep_tag : before.r_tagged;
      made.policed_frame = models::frame_length(msdu, frame.tagged, is_policed_tagged);
      made.policed_msdu = msdu + (is_policed_tagged ? models::r_tag : Octets{0});
      if (redundancy != nullptr) before = hops[i];
      if (before.member) made.member = static_cast<std::uint32_t>(*before.member);
      if (!is_met_once && !seen_.insert({made.member ? *made.member + 1 : 0, path[i], port}).second) continue;
      const models::PortConfig& config = *configs_.at(path[i], port);
      const bool tagged = frame.tagged && !strips_tags(r_.topology, config, path[i], i == 0);
      made.frame = models::frame_length(msdu, tagged, before.r_tagged);
      made.msdu = msdu + (before.r_tagged ? models::r_tag : Octets{0});
      made.classes =
          ingress_.classes(path[i], config, made.filter, i == 0 ? plan.priority_at_talker() : frame.priority);
      visit_(made);
    }
  }

  const Resolved& r_;
  const std::function<void(const StreamAtPort&)>& visit_;
  IngressClasses ingress_;
  PortTable<const models::PortConfig*> configs_;
  std::map<std::uint32_t, const ResolvedRedundancy*> redundancies_;
  std::set<std::tuple<std::size_t, std::uint32_t, std::uint16_t>> seen_;  // of one stream: member, node, port
};

}  // namespace

bool begins_after_the_start(const models::NodePlan& node, const models::StreamGateConfig& gate) {
  const sim::LocalTime start = sim::LocalTime() + (node.clock ? node.clock->initial_offset : Duration());
  const sim::LocalTime asked = models::first_request(sim::LocalTime(), gate.admin_base_time, gate.is_running);
  return models::first_cycle_from(asked, gate.admin_base_time, gate.admin_cycle_time) > start;
}

std::vector<StreamAtPort> streams_at_ports(const Resolved& resolved) {
  std::vector<StreamAtPort> found;
  std::size_t most = 0;
  for (const ResolvedStream& stream : resolved.streams)
    for (const Path& path : stream.paths) most += path.size() - 1;
  found.reserve(most);
  for_each_stream_at_port(resolved, [&](const StreamAtPort& at) { found.push_back(at); });
  return found;
}

void for_each_stream_at_port(const Resolved& resolved, const std::function<void(const StreamAtPort&)>& visit) {
  Walker(resolved, visit).run();
}

models::ClassSet IngressClasses::classes(std::uint32_t node, const models::PortConfig& port,
                                         std::optional<std::uint32_t> filter, models::Priority priority) const {
  const models::TrafficClass own = port.traffic_class_of_priority[priority];
  const models::ClassSet only_own = models::with(0, own);
  if (!filter) return only_own;
  const models::IngressConfig& ingress = r_.plan.ingress_configs[*r_.plan.nodes[node].ingress];
  const models::StreamGateIndex number = ingress.stream_filters[*filter].stream_gate;
  if (number.is_none()) return only_own;
  const models::StreamGateConfig& gate = ingress.stream_gates[number.value];
  const auto class_of = [&](const std::optional<models::Priority>& ipv) {
    return ipv ? port.traffic_class_of_priority[*ipv] : own;
  };
  models::ClassSet classes = 0;
  // Before its list begins a gate is as it was made.
  const bool begins_later = gate.admin_control_list.empty() || begins_after_the_start(r_.plan.nodes[node], gate);
  if (begins_later && gate.admin_gate_open) classes = models::with(classes, class_of(gate.admin_ipv));
  for (const models::StreamGateEntry& entry : gate.admin_control_list)
    if (entry.open) classes = models::with(classes, class_of(entry.ipv));
  return classes;
}

std::optional<std::uint32_t> IngressClasses::filter(std::uint32_t node, const models::Frame& frame) {
  if (!r_.plan.nodes[node].ingress) return std::nullopt;
  const models::IngressConfig& ingress = r_.plan.ingress_configs[*r_.plan.nodes[node].ingress];
  if (ingress.stream_filters.empty()) return std::nullopt;
  auto table = tables_.find(node);
  if (table == tables_.end())
    table = tables_
                .emplace(node, models::StreamTable(ingress.stream_identity_table,
                                                   static_cast<std::uint32_t>(r_.plan.nodes.size())))
                .first;
  const models::StreamHandle handle = table->second.identify(frame).stream;
  for (std::uint32_t i = 0; i < ingress.stream_filters.size(); ++i) {
    const models::StreamFilterConfig& filter = ingress.stream_filters[i];
    const bool is_of_nothing = filter.stream_handle && filter.stream_handle->is_none();  // its name was refused
    if (!is_of_nothing && models::StreamFilter(filter).matches(handle, frame.priority)) return i;
  }
  return std::nullopt;
}

}  // namespace takt::scenario
