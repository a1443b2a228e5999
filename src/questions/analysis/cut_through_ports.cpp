// SPDX-License-Identifier: Apache-2.0
#include "analysis/cut_through_ports.hpp"

#include <algorithm>

#include "analysis/flow_sources.hpp"
#include "models/egress/class_set.hpp"
#include "models/ethernet/sizes.hpp"

namespace takt::analysis {
namespace {

Ps last_bit_of(const GraphPort& port, sim::Octets frame) {
  return port.octet_time * (models::wire_length(frame) - models::inter_packet_gap).count;
}

Ps header_at(const scenario::Resolved& r, const GraphPort& port) {
  return port.octet_time * (r.plan.nodes[port.node.value].cut_through_header + models::vlan_tag).count;
}

/// Whatever else the port does: it passes frames on as they come, and so does its node.
bool may_cut_all(const scenario::Resolved& r, const FlowGraph& graph, std::uint32_t p) {
  const GraphPort& port = graph.ports[p];
  const PortModel& model = graph.models[p];
  const models::PortConfig& config = *model.config;
  const auto is_limited = [](const sim::Octets& sdu) { return sdu.count != 0; };
  if (port.hops.empty() || !model.counts_packets || config.preemption || config.untagged || !model.more_gates.empty() ||
      model.cqf || r.plan.nodes[port.node.value].ingress || !config.shaping.has_strict_priority_only() ||
      std::any_of(config.shaping.queue_max_sdu.begin(), config.shaping.queue_max_sdu.end(), is_limited))
    return false;
  if (r.plan.links[port.link].may_fail)
    return false;  // a header that comes while the link is down is a frame that is stored
  for (std::size_t other = 0; other < graph.ports.size(); ++other)  // eligibility times ask for the last bit
    if (graph.ports[other].node == port.node && graph.models[other].config->shaping.timed() != 0) return false;
  return true;
}

/// The frame comes by one link of the same rate, with its tag, and the port is asked to cut its class through.
bool may_cut(const scenario::Resolved& r, const FlowGraph& graph, std::uint32_t h) {
  const Hop& hop = graph.hops[h];
  const GraphPort& port = graph.ports[hop.port];
  const models::StreamIndex stream = graph.flows[hop.flow].stream;
  if (!hop.headers_come_first || hop.parents.size() != 1 || hop.is_copied_here ||
      hop.lowest_class != hop.highest_class || !hop.unsupported.empty())
    return false;
  const std::uint32_t from = graph.hops[hop.parents.front()].port;
  const GraphPort& link = graph.ports[from];
  if (link.octet_time != port.octet_time || link.may_double || graph.models[from].config->preemption) return false;
  for (std::uint32_t before = h; !graph.hops[before].parents.empty();) {  // the header of an untagged frame is shorter
    before = graph.hops[before].parents.front();
    if (graph.models[graph.hops[before].port].config->untagged) return false;
  }
  const bool is_redundant =
      std::any_of(r.redundancies.begin(), r.redundancies.end(),
                  [&](const scenario::ResolvedRedundancy& each) { return each.stream == stream; });
  if (is_redundant || !r.plan.streams[stream.value].priority ||
      !models::contains(graph.models[hop.port].config->cut_through, hop.highest_class))
    return false;
  return header_at(r, port) < last_bit_of(port, hop.frame);
}

}  // namespace

std::optional<Ps> header_of_all(const scenario::Resolved& r, const FlowGraph& graph, std::uint32_t p) {
  const GraphPort& port = graph.ports[p];
  if (!may_cut_all(r, graph, p) || graph.models[p].config->shaping.gates || !gptp_messages(r, port.node).empty())
    return std::nullopt;
  for (const std::uint32_t h : port.hops)
    if (!may_cut(r, graph, h) || graph.hops[graph.hops[h].parents.front()].port !=
                                     graph.hops[graph.hops[port.hops.front()].parents.front()].port)
      return std::nullopt;
  return header_at(r, port);
}

std::optional<Ps> header_ahead(const scenario::Resolved& r, const FlowGraph& graph, std::uint32_t h) {
  const Hop& hop = graph.hops[h];
  const bool is_gated = graph.models[hop.port].config->shaping.gates.has_value();
  if (!is_gated || hop.frame != hop.shortest || !may_cut_all(r, graph, hop.port) || !may_cut(r, graph, h))
    return std::nullopt;
  return last_bit_of(graph.ports[hop.port], hop.frame) - header_at(r, graph.ports[hop.port]);
}

std::optional<PortBound> bound_cut_through(const scenario::Resolved& r, const FlowGraph& graph, std::uint32_t p,
                                           const PortTraffic& traffic, const std::vector<HopResult>& hops,
                                           const std::vector<std::optional<Ps>>& ahead) {
  const GraphPort& port = graph.ports[p];
  const auto is_cut = [&](std::uint32_t h) { return ahead[h].has_value(); };
  if (std::none_of(port.hops.begin(), port.hops.end(), is_cut)) return std::nullopt;
  PortTraffic headers = traffic;
  for (std::size_t i = 0; i < port.hops.size(); ++i) {
    if (!is_cut(port.hops[i])) continue;
    const std::uint32_t parent = graph.hops[port.hops[i]].parents.front();
    const std::optional<ArrivalPhase>& leaves = hops[parent].leaves;
    if (!leaves) return std::nullopt;
    const Ps sooner = *ahead[port.hops[i]];
    const Ps delay = r.plan.nodes[port.node.value].greatest_forwarding_delay().ps();  // such nodes have no jitter
    const Ps on_the_way = sum(graph.ports[graph.hops[parent].port].propagation, delay);
    const std::int64_t rate = std::max(graph.models[p].clock.rate_ppt, leaves->rate_ppt);
    const Ps least = scaled_down(on_the_way, one_ppt - rate, one_ppt) - scaled_up(sooner, one_ppt + rate, one_ppt);
    const Ps most = scaled_up(on_the_way, one_ppt + rate, one_ppt) - scaled_down(sooner, one_ppt - rate, one_ppt);
    headers.flows[i].phase = ArrivalPhase{leaves->first + least, leaves->period, leaves->width + most - least,
                                          leaves->clock, leaves->rate_ppt};
  }
  PortBound bound = bound_port(graph.models[p], headers);
  for (std::size_t i = 0; i < port.hops.size(); ++i) {
    const bool is_at_once =
        bound.flows[i].delay == last_bit_of(port, graph.hops[port.hops[i]].frame) && bound.flows[i].leaves;
    if (is_cut(port.hops[i]) && !is_at_once) return std::nullopt;
  }
  return bound;
}

}  // namespace takt::analysis
