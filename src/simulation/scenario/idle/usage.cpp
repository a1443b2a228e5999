// SPDX-License-Identifier: Apache-2.0
#include "scenario/idle/usage.hpp"

#include <algorithm>
#include <set>
#include <tuple>

#include "models/bridge/internal_port.hpp"
#include "models/ethernet/sizes.hpp"
#include "scenario/resolve/port_configs.hpp"
#include "scenario/resolve/stream_at_port.hpp"

namespace takt::scenario {
namespace {

const std::vector<Egress>& egress_of(const TopologyNode& node) { return ports_of(node.description).egress; }

/// What tells one object of a file from others: generated nodes are copies of one.
std::string key_of(const json::Source& where, const void* object) {
  return where.is_known() ? where.place().pointer : std::to_string(reinterpret_cast<std::uintptr_t>(object));
}

}  // namespace

Usage::Usage(const Resolved& resolved) : r_(resolved), streams_(streams_at_ports(resolved)), place_(resolved.topology) {
  add_ports();
  for (const ResolvedAction& action : r_.script)
    if (const auto* gates = std::get_if<ResolvedGates>(&action.what))
      use(gates->node.value, gates->port).gates.push_back(&gates->gates);
  add_rerouted();
  add_streams();
  add_gptp();
  add_egress();
  add_ingress();
}

void Usage::add_ports() {
  for (const models::LinkPlan& link : r_.plan.links)
    for (const auto& [end, peer] : {std::pair(&link.a, &link.b), std::pair(&link.b, &link.a)}) {
      PortUse use;
      use.node = end->node.value;
      use.port = end->port;
      use.peer = peer->node.value;
      use.link = &link;
      use.config = &port_config_of(r_.plan, *end);
      if (use.config->shaping.gates) use.gates.push_back(&*use.config->shaping.gates);
      ports_.push_back(std::move(use));
    }
  std::ranges::sort(ports_, {}, [](const PortUse& use) { return std::pair(use.node, use.port); });
  for (std::uint32_t i = 0; i < ports_.size(); ++i) place_.at(ports_[i].node, ports_[i].port) = i;
}

/// Streams come over other ports, too, once rerouting has found other ways. Appended before anybody points into the
/// list.
void Usage::add_rerouted() {
  if (std::none_of(r_.script.begin(), r_.script.end(),
                   [](const ResolvedAction& action) { return std::holds_alternative<ResolvedRoutes>(action.what); }))
    return;
  IngressClasses ingress(r_);
  std::set<std::tuple<std::uint32_t, std::uint16_t, std::uint32_t>> known;
  for (const StreamAtPort& at : streams_) known.insert({at.node, at.port, at.stream.value});
  for (const ResolvedAction& action : r_.script) {
    const auto* const routes = std::get_if<ResolvedRoutes>(&action.what);
    if (routes == nullptr) continue;
    for (const ResolvedRoutes::Entry& entry : routes->entries)
      for (const ResolvedStream& stream : r_.streams) {
        const models::StreamPlan& plan = r_.plan.streams[stream.index.value];
        if (plan.destination != entry.address || plan.vlan != entry.vlan) continue;
        models::Frame frame;
        frame.stream = stream.index;
        frame.source = models::AddressIndex{plan.talker.value};
        frame.destination = plan.destination;
        frame.vlan = plan.vlan;
        frame.priority = plan.priority.value_or(0);
        frame.tagged = plan.priority.has_value();
        for (const std::uint16_t port : entry.ports) {
          if (port == models::internal_port) continue;
          if (!known.insert({entry.node.value, port, stream.index.value}).second) continue;
          const PortUse& use = this->port(entry.node.value, port);
          const Octets msdu = plan.headers + stream.largest_payload;
          StreamAtPort at{.stream = stream.index, .node = use.node, .port = port, .peer = use.peer};
          if (use.node != plan.talker.value) at.filter = ingress.filter(use.node, frame);
          at.classes = ingress.classes(use.node, *use.config, at.filter,
                                       use.node == plan.talker.value ? plan.priority_at_talker() : frame.priority);
          at.frame = at.policed_frame = models::frame_length(
              msdu, frame.tagged && !strips_tags(r_.topology, *use.config, use.node, use.node == plan.talker.value));
          at.msdu = at.policed_msdu = msdu;
          streams_.push_back(at);
        }
      }
  }
}

void Usage::add_streams() {
  for (const StreamAtPort& at : streams_) {
    PortUse& use = this->use(at.node, at.port);
    use.streams.push_back(&at);
    use.classes = static_cast<models::ClassSet>(use.classes | at.classes);
  }
}

void Usage::add_gptp() {
  for (PortUse& use : ports_) {
    const bool speaks = use.node < r_.plan.gptp.size() && r_.plan.gptp[use.node] && r_.plan.gptp[use.peer];
    if (!speaks) continue;
    use.classes_of_gptp = models::with(0, use.config->traffic_class_of_priority[priority_of_gptp]);
    use.classes = static_cast<models::ClassSet>(use.classes | use.classes_of_gptp);
  }
}

void Usage::add_egress() {
  std::map<std::string, std::size_t> known;
  for (std::uint32_t n = 0; n < r_.topology.nodes.size(); ++n)
    for (const Egress& egress : egress_of(r_.topology.nodes[n])) {
      const auto [found, is_new] = known.emplace(key_of(egress.where, &egress), egress_.size());
      if (is_new) egress_.push_back({&egress, r_.topology.nodes[n].name, {}});
      for (auto at = std::ranges::lower_bound(ports_, n, {}, &PortUse::node); at != ports_.end() && at->node == n;
           ++at) {
        const PortUse& use = *at;
        const Neighbour& peer = *std::ranges::find(r_.topology.neighbours[n], use.port, &Neighbour::port);
        const auto goes_before = [&](const Egress& other) {
          return other.to && r_.topology.is_named(*other.to, peer.node, peer.their_port) &&
                 other.to->size() > egress.to.value_or("").size();
        };
        if (egress.to && !r_.topology.is_named(*egress.to, peer.node, peer.their_port)) continue;
        if (std::ranges::none_of(egress_of(r_.topology.nodes[n]), goes_before))
          egress_[found->second].ports.push_back(&use);
      }
    }
}

void Usage::add_ingress() {
  std::map<std::string, std::size_t> known;
  for (std::uint32_t n = 0; n < r_.topology.nodes.size(); ++n) {
    const Relay* const bridge = relay_of(r_.topology.nodes[n].description);
    if (bridge == nullptr || !bridge->ingress) continue;
    const auto [found, is_new] = known.emplace(key_of(bridge->ingress->where, &*bridge->ingress), ingress_.size());
    if (is_new) ingress_.push_back({&*bridge->ingress, {}});
    ingress_[found->second].nodes.push_back(n);
  }
}

std::string Usage::name(const std::vector<const PortUse*>& ports) const {
  if (ports.size() == 1) return r_.topology.nodes[ports[0]->node].name + ":" + std::to_string(ports[0]->port);
  const bool of_one = !ports.empty() && std::all_of(ports.begin(), ports.end(),
                                                    [&](const PortUse* port) { return port->node == ports[0]->node; });
  return (of_one ? "the " : "") + std::to_string(ports.size()) + " ports" +
         (of_one ? " of " + r_.topology.nodes[ports[0]->node].name : std::string());
}

std::string Usage::why_unused(models::TrafficClass q, const std::vector<const PortUse*>& ports) const {
  const bool has_streams =
      std::any_of(ports.begin(), ports.end(), [](const PortUse* port) { return !port->streams.empty(); });
  if (!has_streams) return "no stream leaves there";
  // Most take the class for the priority.
  const std::optional<models::TrafficClass> meant = class_of_priority(q, ports);
  return "no stream goes there" +
         (meant ? "; priority " + std::to_string(q) + " is class " + std::to_string(*meant) : std::string());
}

std::optional<models::TrafficClass> Usage::class_of_priority(models::Priority priority,
                                                             const std::vector<const PortUse*>& ports) const {
  for (const PortUse* port : ports)
    for (const StreamAtPort* at : port->streams) {
      const models::TrafficClass own = port->config->traffic_class_of_priority[priority];
      if (plan(*at).priority.value_or(0) == priority && own != priority) return own;
    }
  return std::nullopt;
}

std::string Usage::classes_in_use(const std::vector<const PortUse*>& ports) const {
  models::ClassSet all = 0;
  for (const PortUse* port : ports) all = static_cast<models::ClassSet>(all | port->classes);
  if (all == 0) return "streams through it";
  return std::string(all == models::with(0, models::highest_class(all)) ? "the class in use there: "
                                                                        : "one of the classes in use there: ") +
         text_of_classes(all);
}

double Usage::load(const PortUse& port, models::TrafficClass q) const {
  for (const PortDemand& demand : r_.ports)
    if (demand.node.value == port.node && demand.port == port.port) return demand.class_bits_per_second[q];
  return 0;
}

std::string text_of_classes(models::ClassSet classes) {
  std::string text;
  for (models::TrafficClass q = 0; q < models::traffic_class_count; ++q)
    if (models::contains(classes, q)) text += (text.empty() ? "" : ", ") + std::to_string(q);
  return text;
}

void warn_once(json::Diagnostics& diagnostics, json::Place place, std::string message, json::Details details) {
  for (const json::Diagnostic& other : diagnostics.kept())
    if (other.place.pointer == place.pointer || other.place.pointer.starts_with(place.pointer + "/")) return;
  diagnostics.warning(std::move(place), std::move(message), std::move(details));
}

}  // namespace takt::scenario
