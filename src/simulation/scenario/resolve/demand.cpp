// SPDX-License-Identifier: Apache-2.0
#include "scenario/resolve/demand.hpp"

#include <fmt/format.h>

#include <bit>

#include "models/ethernet/sizes.hpp"
#include "scenario/resolve/stream_at_port.hpp"
#include "scenario/topology/port_table.hpp"

namespace takt::scenario {
namespace {

std::string percent(double share) { return fmt::format("{:.1f} %", 100 * share); }

}  // namespace

std::vector<PortDemand> demands_of(const Resolved& r, json::Diagnostics& diagnostics) {
  PortTable<PortDemand> ports(r.topology);
  for (const models::LinkPlan& link : r.plan.links) {
    const auto rate = static_cast<double>(link.rate.bits_per_second);
    ports.at(link.a.node.value, link.a.port) = {link.a.node, link.a.port, link.b.node, rate, {}};
    ports.at(link.b.node.value, link.b.port) = {link.b.node, link.b.port, link.a.node, rate, {}};
  }
  for_each_stream_at_port(r, [&](const StreamAtPort& at) {
    const ResolvedStream& stream = r.streams[at.stream.value];
    const models::StreamPlan& plan = r.plan.streams[at.stream.value];
    const Octets made = models::frame_length(plan.headers + stream.largest_payload, plan.priority.has_value());
    const double longer =
        8.0 * (static_cast<double>(at.frame.count) - static_cast<double>(made.count));  // R-TAG on, C-tag off
    const double bits = stream.demand.wire_bits_per_second + longer * stream.demand.frames_per_second;
    // A stream gate that spreads a stream over classes, as cyclic queuing does, gives each its turn.
    const int classes = std::popcount(at.classes);
    for (models::TrafficClass q = 0; q < models::traffic_class_count; ++q)
      if (models::contains(at.classes, q)) ports.at(at.node, at.port).class_bits_per_second[q] += bits / classes;
  });
  std::vector<PortDemand> all;
  for (const PortDemand& port : ports.values()) {
    if (port.link_bits_per_second == 0) continue;  // no link ends there
    const double share = port.share();
    if (share <= 0) continue;
    const std::string from = r.plan.nodes[port.node.value].name;
    const std::string to = r.plan.nodes[port.peer.value].name;
    const json::Details details{percent(share) + " from " + json::quote(from) + " to " + json::quote(to),
                                "at most 100 % (or \"allow_overload\": true)"};
    if (share > 1.0 + 1e-9 && !r.scenario.allow_overload)
      diagnostics.error_unless(!r.topology.has_all_links ||
                                   diagnostics.is_refused(r.scenario.network.where.at("links")) ||
                                   diagnostics.is_refused(r.scenario.network.where.at("generate")) ||
                                   diagnostics.is_refused(r.scenario.where.at("allow_overload")),
                               r.scenario.network.where.place(), "an overloaded link", details);
    else if (share > 1.0 + 1e-9)
      diagnostics.warning(r.scenario.network.where.place(), "an overloaded link", {details.found});
    else if (share > 0.9)
      diagnostics.warning(r.scenario.network.where.place(), "a link that is nearly full", {details.found});
    all.push_back(port);
  }
  return all;
}

}  // namespace takt::scenario
