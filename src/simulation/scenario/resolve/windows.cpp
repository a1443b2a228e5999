// SPDX-License-Identifier: Apache-2.0
#include "scenario/resolve/windows.hpp"

#include <algorithm>
#include <array>
#include <set>
#include <utility>

#include "models/ethernet/sizes.hpp"
#include "scenario/resolve/gptp_links.hpp"
#include "scenario/resolve/port_configs.hpp"
#include "scenario/resolve/stream_at_port.hpp"
#include "scenario/topology/port_table.hpp"

namespace takt::scenario {
namespace {

/// Everything that opens gates of a port at some time of the run.
struct PortGates {
  const models::LinkPlan* link = nullptr;
  std::array<Duration, models::traffic_class_count> longest_window{};  ///< of all lists
  bool has_list = false;
  models::ClassSet stuck_open = 0;
  bool is_open_without_list = false;  // no list from the beginning on, so that all gates are open at first
};

void add(PortGates& port, const models::GateConfig& gates) {
  port.has_list = true;
  const bool is_refused = gates.admin_cycle_time <= Duration() || gates.admin_control_list.empty();
  if (is_refused) return port.longest_window.fill(Duration::max());
  const models::GateControlList list(gates.admin_control_list, gates.admin_cycle_time);
  for (models::TrafficClass q = 0; q < models::traffic_class_count; ++q)
    port.longest_window[q] = std::max(port.longest_window[q], list.longest_window(q));
}

PortTable<PortGates> gates_of_ports(const Resolved& r) {
  PortTable<PortGates> ports(r.topology);
  for (const models::LinkPlan& link : r.plan.links)
    for (const models::LinkPlan::End* end : {&link.a, &link.b}) {
      PortGates& port = ports.at(end->node.value, end->port);
      port.link = &link;
      const std::optional<models::GateConfig>& gates = port_config_of(r.plan, *end).shaping.gates;
      // A list that begins when the run is over does not act.
      if (gates && (r.scenario.duration == Duration() || gates->admin_base_time.since_start() < r.scenario.duration))
        add(port, *gates);
      else
        port.is_open_without_list = true;
    }
  for (const ResolvedAction& action : r.script) {
    if (const auto* gates = std::get_if<ResolvedGates>(&action.what))
      add(ports.at(gates->node.value, gates->port), gates->gates);
    if (const auto* stuck = std::get_if<ResolvedStuckGate>(&action.what);
        stuck != nullptr && stuck->open.value_or(false)) {
      PortGates& port = ports.at(stuck->node.value, stuck->port);
      port.stuck_open = models::with(port.stuck_open, stuck->traffic_class);
    }
  }
  return ports;
}

/// The cycle of cyclic queuing is checked with its own words.
bool is_of_cqf(const Resolved& r, const StreamAtPort& at) {
  if (!at.filter) return false;
  const models::IngressConfig& ingress = r.plan.ingress_configs[*r.plan.nodes[at.node].ingress];
  const models::StreamGateIndex gate = ingress.stream_filters[*at.filter].stream_gate;
  return !gate.is_none() && ingress.stream_gates[gate.value].name == "cqf";
}

/// Clocks behind a gate that never opens for gPTP run free.
void check_gptp(const Resolved& r, const PortTable<PortGates>& ports, json::Diagnostics& diagnostics) {
  if (r.plan.gptp.empty() || !r.scenario.clocks.gptp) return;
  const std::vector<GptpFrames> frames = longest_gptp_frames(r);
  std::set<std::uint32_t> told;
  for (const models::LinkPlan& link : r.plan.links)
    for (const auto& [own, peer] : {std::pair(&link.a, &link.b), std::pair(&link.b, &link.a)}) {
      const PortGates& port = ports.at(own->node.value, own->port);
      if (!r.plan.gptp[own->node.value] || !r.plan.gptp[peer->node.value] || port.is_open_without_list ||
          !port.has_list)
        continue;
      const models::TrafficClass q = port_config_of(r.plan, *own).traffic_class_of_priority[priority_of_gptp];
      const Duration needed = link.rate.octet_time() *
                              (models::preamble_and_sfd + frames[own->node.value].to(frames[peer->node.value])).count;
      if (models::contains(port.stuck_open, q) || port.longest_window[q] >= needed ||
          !told.insert(own->node.value).second)
        continue;
      diagnostics.error(r.scenario.clocks.gptp->where.place(), "gPTP that no gate window lets pass",
                        {json::to_text(needed) + " for a frame of class " + std::to_string(q) + " from " +
                             json::quote(r.topology.nodes[own->node.value].name) + " to " +
                             json::quote(r.topology.nodes[peer->node.value].name) + ", whose longest window there is " +
                             json::to_text(port.longest_window[q]),
                         "a window that holds its longest frame, or the node in \"without\""});
    }
}

}  // namespace

void check_windows(const Resolved& r, json::Diagnostics& diagnostics) {
  const PortTable<PortGates> ports = gates_of_ports(r);
  if (std::ranges::none_of(ports.values(), [](const PortGates& port) { return port.has_list; })) return;
  std::set<std::pair<std::uint32_t, std::uint32_t>>
      told;  // stream, node: the paths of members and several ports say the same
  // Lists and classes that were refused let nobody say what passes.
  const auto is_in_doubt = [&](const json::Place& place) { return diagnostics.is_refused(place); };
  if (is_in_doubt(r.scenario.network.where.at("links")) || is_in_doubt(r.scenario.network.where.at("generate")) ||
      is_in_doubt(r.scenario.where.at("gates")) || is_in_doubt(r.scenario.where.at("script")))
    return;
  for_each_stream_at_port(r, [&](const StreamAtPort& at) {
    const PortGates& port = ports.at(at.node, at.port);
    if (port.is_open_without_list || !port.has_list || at.classes == 0 || is_of_cqf(r, at)) return;
    if (is_in_doubt(r.topology.nodes[at.node].where.place()) || is_in_doubt(r.streams[at.stream.value].where.place()))
      return;
    const Duration needed = port.link->rate.octet_time() * (models::preamble_and_sfd + at.frame).count;
    models::ClassSet shut = 0;
    for (models::TrafficClass q = 0; q < models::traffic_class_count; ++q)
      if (models::contains(at.classes, q) && !models::contains(port.stuck_open, q) && port.longest_window[q] < needed)
        shut = models::with(shut, q);
    if (shut == 0 || !told.insert({at.stream.value, at.node}).second) return;
    const models::TrafficClass q = models::highest_class(shut);
    const ResolvedStream& stream = r.streams[at.stream.value];
    const json::Details details{json::to_text(needed) + " for a frame of class " + std::to_string(q) + " at " +
                                    json::quote(r.topology.nodes[at.node].name) + ", whose longest window is " +
                                    json::to_text(port.longest_window[q]),
                                "a window that holds the longest frame"};
    if (shut == at.classes)
      diagnostics.error(stream.where.place(), "a frame that no gate window lets pass", details);
    else
      diagnostics.warning(stream.where.place(),
                          "frames that no gate window lets pass, when their stream gate puts them into that class",
                          details);
  });
  check_gptp(r, ports, diagnostics);
}

}  // namespace takt::scenario
