#include "scenario/resolve/demand.hpp"

#include <fmt/format.h>

#include <map>
#include <set>
#include <utility>

#include "models/ethernet/sizes.hpp"

namespace takt::scenario {
namespace {

using Key = std::pair<std::uint32_t, std::uint16_t>;  // node, port

const ResolvedRedundancy* redundancy_of(const Resolved& r, const ResolvedStream& stream) {
  for (const ResolvedRedundancy& redundancy : r.redundancies)
    if (redundancy.stream == stream.index) return &redundancy;
  return nullptr;
}

std::string percent(double share) { return fmt::format("{:.1f} %", 100 * share); }

}  // namespace

void resolve_demand(Resolved& r, json::Diagnostics& diagnostics) {
  std::map<Key, PortDemand> ports;
  for (const models::LinkPlan& link : r.plan.links) {
    const auto rate = static_cast<double>(link.rate.bits_per_second);
    ports[{link.a.node.value, link.a.port}] = {link.a.node, link.a.port, link.b.node, rate, {}};
    ports[{link.b.node.value, link.b.port}] = {link.b.node, link.b.port, link.a.node, rate, {}};
  }
  for (const ResolvedStream& stream : r.streams) {
    const models::StreamPlan& plan = r.plan.streams[stream.index.value];
    const ResolvedRedundancy* const redundancy = redundancy_of(r, stream);
    std::set<Key> used;  // a multicast takes each link once
    for (const Path& path : stream.paths) {
      bool is_member = false;  // of a redundant stream: each takes the link for itself, with an R-TAG
      for (std::size_t i = 0; i + 1 < path.size(); ++i) {
        const std::uint16_t port = *r.topology.port_towards(path[i], path[i + 1]);
        if (redundancy != nullptr) is_member = path[i] == redundancy->split || (is_member && path[i] != redundancy->merge);
        if (!is_member && !used.insert({path[i], port}).second) continue;
        const models::PortConfig& config = r.plan.port_configs[r.plan.nodes[path[i]].port_config];
        const models::TrafficClass q = config.traffic_class_of_priority[plan.priority.value_or(0)];
        ports[{path[i], port}].class_bits_per_second[q] +=
            stream.demand.wire_bits_per_second + (is_member ? 8.0 * models::r_tag.count * stream.demand.frames_per_second : 0);
      }
    }
  }
  for (auto& [key, port] : ports) {
    const double share = port.share();
    if (share <= 0) continue;
    const std::string from = r.plan.nodes[port.node.value].name;
    const std::string to = r.plan.nodes[port.peer.value].name;
    const json::Details details{percent(share) + " from " + json::quote(from) + " to " + json::quote(to), "at most 100 % (or \"allow_overload\": true)"};
    if (share > 1.0 + 1e-9 && !r.scenario.allow_overload)
      diagnostics.error(r.scenario.network.where.place(), "an overloaded link", details);
    else if (share > 1.0 + 1e-9)
      diagnostics.warning(r.scenario.network.where.place(), "an overloaded link", {details.found});
    else if (share > 0.9)
      diagnostics.warning(r.scenario.network.where.place(), "a link that is nearly full", {details.found});
    r.ports.push_back(port);
  }
}

}  // namespace takt::scenario
