// SPDX-License-Identifier: Apache-2.0
// IEEE 802.1BA: links, gPTP with the defaults of IEEE 802.1AS, and the stream reservation classes of IEEE 802.1Q 34.
#include <algorithm>
#include <map>
#include <set>
#include <tuple>

#include "json/quantity.hpp"
#include "profile/common.hpp"
#include "profile/rules.hpp"
#include "scenario/resolve/port_configs.hpp"
#include "scenario/resolve/stream_at_port.hpp"

namespace takt::profile {
namespace {

using scenario::Resolved;
using sim::Duration;
using namespace sim::literals;  // NOLINT: limits

constexpr models::Priority class_a = 3;
constexpr models::Priority class_b = 2;

bool is_reserved_stream(const models::StreamPlan& plan) { return plan.priority == class_a || plan.priority == class_b; }

std::string port_name(const Resolved& r, std::uint32_t node, std::uint16_t port) {
  return r.topology.nodes[node].name + ":" + std::to_string(port);
}

/// The configuration and the link of a port.
struct PortOf {
  const models::PortConfig* config = nullptr;
  const models::LinkPlan* link = nullptr;
};
PortOf port_of(const Resolved& r, std::uint32_t node, std::uint16_t port) {
  for (const models::LinkPlan& link : r.plan.links)
    for (const models::LinkPlan::End* const end : {&link.a, &link.b})
      if (end->node.value == node && end->port == port) return {&scenario::port_config_of(r.plan, *end), &link};
  return {};
}

void look_at_rates(const Resolved& r, Found& found) {
  std::vector<std::string> slow;
  for (const models::LinkPlan& link : r.topology.links)
    if (link.rate < sim::DataRate{100'000'000})
      slow.push_back(r.topology.nodes[link.a.node.value].name + " - " + r.topology.nodes[link.b.node.value].name +
                     " of " + json::to_text(link.rate));
  found.judge(slow.empty(), slow.empty() ? "all links" : some_of(slow));
}

void look_at_presence_of_gptp(const Resolved& r, Found& found) {
  found.judge(r.scenario.clocks.gptp.has_value(), r.scenario.clocks.gptp ? "gPTP" : "no gPTP",
              r.scenario.clocks.where.place());
}
void look_at_sync(const Resolved& r, Found& found) {
  judge_interval(r, found, -3, &scenario::Gptp::log_sync_interval, "log_sync_interval");
}
void look_at_announce(const Resolved& r, Found& found) {
  judge_interval(r, found, 0, &scenario::Gptp::log_announce_interval, "log_announce_interval");
}
void look_at_pdelay(const Resolved& r, Found& found) {
  judge_interval(r, found, 0, &scenario::Gptp::log_pdelay_interval, "log_pdelay_interval");
}

void look_at_cables(const Resolved& r, Found& found) {
  if (!r.scenario.clocks.gptp) return found.unknown("no gPTP");
  std::vector<std::string> far;
  for (const models::LinkPlan& link : r.topology.links)
    if (link.delay > 800_ns)
      far.push_back(r.topology.nodes[link.a.node.value].name + " - " + r.topology.nodes[link.b.node.value].name +
                    " of " + json::to_text(link.delay));
  found.judge(far.empty(), far.empty() ? "all links" : some_of(far));
}

/// Each port with streams of class A or B, once for a class.
void look_at_shapers(const Resolved& r, Found& found) {
  std::vector<std::string> without;
  std::set<std::tuple<std::uint32_t, std::uint16_t, models::Priority>> seen;
  for (const scenario::StreamAtPort& at : scenario::streams_at_ports(r)) {
    const models::StreamPlan& plan = r.plan.streams[at.stream.value];
    if (!is_reserved_stream(plan) || !seen.insert({at.node, at.port, *plan.priority}).second) continue;
    const PortOf port = port_of(r, at.node, at.port);
    const models::TrafficClass q = port.config->traffic_class_of_priority[*plan.priority];
    if (port.config->shaping.shaper_of(q) == nullptr) without.push_back(port_name(r, at.node, at.port));
  }
  if (seen.empty()) return found.unknown("no stream with PCP 3 (class A) or 2 (class B)");
  found.judge(without.empty(), without.empty() ? "all ports" : "none at " + some_of(without));
}

void look_at_share(const Resolved& r, Found& found) {
  std::vector<std::string> beyond;
  std::set<std::pair<std::uint32_t, std::uint16_t>> seen;
  for (const scenario::StreamAtPort& at : scenario::streams_at_ports(r)) {
    if (!is_reserved_stream(r.plan.streams[at.stream.value]) || !seen.insert({at.node, at.port}).second) continue;
    const PortOf port = port_of(r, at.node, at.port);
    std::uint64_t sum = 0;
    for (models::TrafficClass q = 0; q < models::traffic_class_count; ++q)
      if (const auto* const shaper = port.config->shaping.shaper_of(q)) sum += shaper->idle_slope.bits_per_second;
    if (sum > port.link->rate.bits_per_second / 4 * 3) beyond.push_back(port_name(r, at.node, at.port));
  }
  if (seen.empty()) return found.unknown("no stream with PCP 3 (class A) or 2 (class B)");
  found.judge(beyond.empty(), beyond.empty() ? "all ports" : "more at " + some_of(beyond));
}

/// Nothing else lies in a class above theirs.
void look_at_order(const Resolved& r, Found& found) {
  std::map<std::pair<std::uint32_t, std::uint16_t>, models::TrafficClass> lowest;
  const auto ports = scenario::streams_at_ports(r);
  for (const scenario::StreamAtPort& at : ports) {
    const models::StreamPlan& plan = r.plan.streams[at.stream.value];
    if (!is_reserved_stream(plan)) continue;
    const models::TrafficClass q = port_of(r, at.node, at.port).config->traffic_class_of_priority[*plan.priority];
    const auto [kept, is_new] = lowest.try_emplace({at.node, at.port}, q);
    if (!is_new) kept->second = std::min(kept->second, q);
  }
  if (lowest.empty()) return found.unknown("no stream with PCP 3 (class A) or 2 (class B)");
  std::vector<std::string> above;
  for (const scenario::StreamAtPort& at : ports) {
    const models::StreamPlan& plan = r.plan.streams[at.stream.value];
    const auto port = lowest.find({at.node, at.port});
    if (is_reserved_stream(plan) || port == lowest.end()) continue;
    if (at.classes >> (port->second + 1) != 0) above.push_back(plan.name + " at " + port_name(r, at.node, at.port));
  }
  found.judge(above.empty(), above.empty() ? "none" : some_of(above));
}

void look_at_paths(const Resolved& r, Found& found) {
  std::vector<std::string> far;
  bool has_any = false;
  for (const scenario::ResolvedStream& stream : r.streams) {
    const models::StreamPlan& plan = r.plan.streams[stream.index.value];
    if (!is_reserved_stream(plan)) continue;
    has_any = true;
    for (const scenario::Path& path : stream.paths)
      if (path.size() > 8) {
        far.push_back(plan.name + " over " + std::to_string(path.size() - 1));
        break;
      }
  }
  if (!has_any) return found.unknown("no stream with PCP 3 (class A) or 2 (class B)");
  found.judge(far.empty(), far.empty() ? "all streams" : some_of(far));
}

constexpr Rule table_of_avb[] = {
    {"IEEE 802.1BA 6", "Links", "full duplex of at least 100 Mb/s", look_at_rates},
    {"IEEE 802.1BA 6", "Synchronisation", "gPTP", look_at_presence_of_gptp},
    {"IEEE 802.1AS 10.7.2.3", "Sync interval", "125 ms", look_at_sync},
    {"IEEE 802.1AS 10.7.2.2", "Announce interval", "1 s", look_at_announce},
    {"IEEE 802.1AS 11.5.2.2", "Pdelay interval", "1 s", look_at_pdelay},
    {"IEEE 802.1AS Table 11-1", "Delay of cables", "at most 800 ns (copper)", look_at_cables},
    {"IEEE 802.1Q 34.6", "Shapers of classes A and B", "a credit-based shaper at each port", look_at_shapers},
    {"IEEE 802.1Q 34.3", "Bandwidth of classes A and B", "at most 75 % of a link", look_at_share},
    {"IEEE 802.1Q 34.5", "Traffic above classes A and B", "none", look_at_order},
    {"IEEE 802.1BA 6", "Links that a stream passes", "at most 7", look_at_paths},
};

}  // namespace

std::span<const Rule> rules_of_avb() { return table_of_avb; }

}  // namespace takt::profile
