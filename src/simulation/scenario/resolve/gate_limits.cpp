// SPDX-License-Identifier: Apache-2.0
#include "scenario/resolve/gate_limits.hpp"

#include <algorithm>
#include <map>
#include <set>
#include <string>

#include "scenario/resolve/port_configs.hpp"
#include "scenario/resolve/stream_at_port.hpp"

namespace takt::scenario {
namespace {

const std::optional<GateLimits>& limits_of(const TopologyNode& node) { return ports_of(node.description).gate_limits; }

class LimitsCheck {
 public:
  LimitsCheck(const Resolved& resolved, json::Diagnostics& diagnostics) : r_(resolved), diagnostics_(diagnostics) {}

  void run() {
    for (const TopologyNode& node : r_.topology.nodes) {
      if (!limits_of(node)) continue;
      any_queues_ = any_queues_ || limits_of(node)->queues;
      for (const Egress& egress : ports_of(node.description).egress)
        if (egress.gates) check(node, *egress.gates, egress.where.at("gates"));
    }
    if (r_.scenario.gates)
      for (const SetGates& set : r_.scenario.gates->lists) check(set);
    for (const ScriptEntry& entry : r_.scenario.script)
      if (entry.set_gates) check(*entry.set_gates);
    if (any_queues_ && !diagnostics_.has_errors()) check_queues();
  }

 private:
  void check(const SetGates& set) {
    const auto node = r_.topology.find(set.node);
    if (node && limits_of(r_.topology.nodes[*node])) check(r_.topology.nodes[*node], set.gates, set.where.at("gates"));
  }

  void check(const TopologyNode& node, const Gates& gates, const json::Place& place) {
    if (diagnostics_.is_refused(place) || diagnostics_.is_refused(limits_of(node)->where.place()) ||
        gates.entries.empty())
      return;
    const ListLimits limits = list_limits_of(node);
    Duration sum, shortest = gates.entries.front().interval;
    bool is_granular = true;
    for (const GateEntry& entry : gates.entries) {
      sum += entry.interval;
      shortest = std::min(shortest, entry.interval);
      is_granular = is_granular && entry.interval % limits.granularity == Duration();
    }
    is_granular = is_granular && gates.cycle.value_or(sum) % limits.granularity == Duration();
    const auto refuse = [&](std::string found, std::string expected) {
      // Generated nodes share theirs.
      if (told_.insert(place.pointer + found).second)
        diagnostics_.error(place, beyond_the_device,
                           {std::move(found) + " at " + json::quote(node.name), std::move(expected)});
    };
    if (const auto& most = limits_of(node)->entries; most && gates.entries.size() > *most)
      refuse(std::to_string(gates.entries.size()) + " entries", "at most " + std::to_string(*most));
    if (shortest < limits.least_interval)
      refuse("an entry of " + json::to_text(shortest), "at least " + json::to_text(limits.least_interval));
    if (!is_granular) refuse("a list or a cycle of other steps", "multiples of " + json::to_text(limits.granularity));
  }

  void check_queues() {
    std::map<std::pair<std::uint32_t, std::uint16_t>, models::ClassSet> used;
    for_each_stream_at_port(r_, [&](const StreamAtPort& at) {
      models::ClassSet& classes = used[{at.node, at.port}];
      classes = static_cast<models::ClassSet>(classes | at.classes);
    });
    if (r_.scenario.clocks.gptp)
      for (const models::LinkPlan& link : r_.plan.links)
        for (const models::LinkPlan::End* end : {&link.a, &link.b}) {
          models::ClassSet& classes = used[{end->node.value, end->port}];
          classes = models::with(classes, port_config_of(r_.plan, *end).traffic_class_of_priority[priority_of_gptp]);
        }
    std::set<std::string> told;
    for (const auto& [port, classes] : used) {
      const TopologyNode& node = r_.topology.nodes[port.first];
      if (!limits_of(node) || !limits_of(node)->queues) continue;
      std::string names;
      std::size_t count = 0;
      for (models::TrafficClass q = 0; q < models::traffic_class_count; ++q)
        if (models::contains(classes, q)) names += (count++ == 0 ? "" : ", ") + std::to_string(q);
      const json::Place place = limits_of(node)->where.at("queues");
      if (count <= *limits_of(node)->queues || !told.insert(place.pointer).second) continue;
      std::string peer;
      for (const Neighbour& neighbour : r_.topology.neighbours[port.first])
        if (neighbour.port == port.second) peer = r_.topology.nodes[neighbour.node].name;
      diagnostics_.error(place, "more traffic classes than queues",
                         {json::quote(node.name + " to " + peer) + " sends frames of the classes " + names +
                              ", the device has " + std::to_string(*limits_of(node)->queues) + " queues",
                          "priorities in fewer classes; with " + std::to_string(count) + " queues it holds"});
    }
  }

  const Resolved& r_;
  json::Diagnostics& diagnostics_;
  std::set<std::string> told_;
  bool any_queues_ = false;
};

}  // namespace

ListLimits list_limits_of(const TopologyNode& node) {
  ListLimits limits;
  if (const auto& said = limits_of(node)) {
    limits.entries = std::min<std::size_t>(said->entries.value_or(most_gate_entries), most_gate_entries);
    limits.least_interval = said->least_interval.value_or(limits.least_interval);
    limits.granularity = said->granularity.value_or(limits.granularity);
  }
  return limits;
}

void check_gate_limits(const Resolved& resolved, json::Diagnostics& diagnostics) {
  LimitsCheck(resolved, diagnostics).run();
}

}  // namespace takt::scenario
