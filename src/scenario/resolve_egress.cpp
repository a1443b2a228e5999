#include "scenario/resolve_egress.hpp"

#include <algorithm>
#include <set>

#include "models/ethernet/sizes.hpp"

namespace takt::scenario {
namespace {

const std::vector<Egress>& egress_of(const TopologyNode& node) {
  return std::visit([](const auto& n) -> const std::vector<Egress>& { return n.egress; }, node.description);
}

class EgressResolver {
 public:
  EgressResolver(Resolved& resolved, json::Diagnostics& diagnostics) : r_(resolved), diagnostics_(diagnostics) {}

  void run() {
    for (std::uint32_t n = 0; n < r_.topology.nodes.size(); ++n) check_neighbours(n);
    for (models::LinkPlan& link : r_.plan.links) {
      configure(link.a, link.b, link.rate);
      configure(link.b, link.a, link.rate);
    }
  }

 private:
  void check_neighbours(std::uint32_t n) {
    std::set<std::string> seen;
    for (const Egress& egress : egress_of(r_.topology.nodes[n])) {
      const std::string to = egress.to.value_or("");
      if (!seen.insert(to).second)
        diagnostics_.error(egress.where.place(), "a port configured twice", {egress.to ? json::quote(to) + " a second time" : "all ports a second time", "one entry for a port"});
      if (!egress.to) continue;
      const auto node = r_.topology.find(to);
      if (!node || !r_.topology.port_towards(n, *node))
        diagnostics_.error(egress.where.at("to"), "not a neighbour", {json::quote(to), "a node that a link joins to " + json::quote(r_.topology.nodes[n].name), node ? "" : suggest_node(r_.topology, to, diagnostics_)});
    }
  }

  void configure(models::LinkPlan::End& end, const models::LinkPlan::End& peer, DataRate rate) {
    const TopologyNode& node = r_.topology.nodes[end.node.value];
    const std::string& peer_name = r_.topology.nodes[peer.node.value].name;
    const Egress* chosen = nullptr;
    for (const Egress& egress : egress_of(node))
      if (egress.to == peer_name || (!egress.to && chosen == nullptr)) chosen = &egress;
    if (chosen == nullptr) return;
    models::PortConfig config = r_.plan.port_configs[r_.plan.nodes[end.node.value].port_config];
    config.shaping = shaping_of(*chosen, rate);
    auto& known = r_.plan.port_configs;
    const auto found = std::find(known.begin(), known.end(), config);
    end.port_config = static_cast<std::uint32_t>(found - known.begin());
    if (found == known.end()) known.push_back(std::move(config));
  }

  models::ShapingConfig shaping_of(const Egress& egress, DataRate rate) {
    models::ShapingConfig config;
    if (egress.gates) config.gates = gate_config_of(*egress.gates, diagnostics_);
    std::set<std::uint8_t> shaped;
    for (const Shaper& shaper : egress.shapers) {
      if (!shaped.insert(shaper.traffic_class).second)
        diagnostics_.error(shaper.where.at("class"), "a class shaped twice", {"class " + std::to_string(shaper.traffic_class) + " a second time", "one shaper for a class"});
      if (shaper.idle_slope > rate)
        diagnostics_.error(shaper.where.at("idle_slope"), "a shaper faster than its link", {json::to_text(shaper.idle_slope), "at most " + json::to_text(rate)});
      else
        config.shapers[shaper.traffic_class] = models::ShaperConfig{shaper.idle_slope, shaper.of == SlopeOf::cycle};
    }
    for (const MaxSdu& max_sdu : egress.max_sdu) config.queue_max_sdu[max_sdu.traffic_class] = max_sdu.size;
    return config;
  }

  Resolved& r_;
  json::Diagnostics& diagnostics_;
};

}  // namespace

models::GateConfig gate_config_of(const Gates& gates, json::Diagnostics& diagnostics) {
  models::GateConfig config;
  Duration sum;
  for (const GateEntry& entry : gates.entries) {
    models::GateStates open = 0;
    for (const std::uint8_t q : entry.open) open = static_cast<models::GateStates>(open | 1u << (q & 7u));
    config.admin_control_list.push_back({models::GateOperation::set_gate_states, open, entry.interval});
    sum += entry.interval;
  }
  config.admin_cycle_time = gates.cycle.value_or(sum);
  if (config.admin_cycle_time < sum)
    diagnostics.warning(gates.where.at("cycle"), "the end of the gate list is cut off",
                        {"entries of " + json::to_text(sum) + " in a cycle of " + json::to_text(config.admin_cycle_time), "entries that fit into the cycle"});
  config.admin_cycle_time_extension = gates.extension;
  config.admin_base_time = sim::LocalTime() + gates.base_time;
  return config;
}

void resolve_egress(Resolved& resolved, json::Diagnostics& diagnostics) { EgressResolver(resolved, diagnostics).run(); }

void check_windows(const Resolved& r, json::Diagnostics& diagnostics) {
  for (const models::LinkPlan& link : r.plan.links) {
    for (const models::LinkPlan::End* end : {&link.a, &link.b}) {
      if (!end->port_config || !r.plan.port_configs[*end->port_config].shaping.gates) continue;
      const models::PortConfig& config = r.plan.port_configs[*end->port_config];
      const models::GateConfig& gates = *config.shaping.gates;
      if (gates.admin_cycle_time <= Duration() || gates.admin_control_list.empty()) continue;  // reported already
      const models::GateControlList list(gates.admin_control_list, gates.admin_cycle_time);
      for (const ResolvedStream& stream : r.streams) {
        const bool crosses = std::any_of(stream.paths.begin(), stream.paths.end(), [&](const Path& path) {
          const auto at = std::find(path.begin(), path.end(), end->node.value);
          return at != path.end() && at + 1 != path.end() && r.topology.port_towards(*at, *(at + 1)) == end->port;
        });
        if (!crosses) continue;
        const models::StreamPlan& plan = r.plan.streams[stream.index.value];
        const models::TrafficClass q = config.traffic_class_of_priority[plan.priority.value_or(0)];
        const Octets frame = models::frame_length(plan.headers + stream.largest_payload, plan.priority.has_value());
        const Duration needed = link.rate.octet_time() * (models::preamble_and_sfd + frame).count;
        if (list.longest_window(q) >= needed) continue;
        diagnostics.error(stream.where.place(), "a frame that no gate window lets pass",
                          {json::to_text(needed) + " for a frame of class " + std::to_string(q) + " at " + json::quote(r.topology.nodes[end->node.value].name) + ", whose longest window is " +
                               json::to_text(list.longest_window(q)),
                           "a window that holds the longest frame"});
      }
    }
  }
}

}  // namespace takt::scenario
