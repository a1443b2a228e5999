// SPDX-License-Identifier: Apache-2.0
#include "scenario/resolve/port_abilities.hpp"

#include <set>

namespace takt::scenario {
namespace {

class AbilityCheck {
 public:
  AbilityCheck(const Resolved& resolved, json::Diagnostics& diagnostics) : r_(resolved), diagnostics_(diagnostics) {}

  void run() {
    for (const TopologyNode& node : r_.topology.nodes) {
      if (node.is_of_unknown_kind) continue;
      node_ = &node;
      const NodePorts& ports = ports_of(node.description);
      for (const Queues::PerClass& queue : ports.queues.classes)
        check_class(queue.where.at("class"), queue.traffic_class);
      for (const Egress& egress : ports.egress) check(egress);
      const Relay* const relay = relay_of(node.description);
      if (relay != nullptr && relay->ingress && relay->ingress->cqf) check_cqf(*relay->ingress->cqf);
    }
    if (r_.scenario.gates)
      for (const SetGates& set : r_.scenario.gates->lists) check(set);
    for (const ScriptEntry& entry : r_.scenario.script)
      if (entry.set_gates) check(*entry.set_gates);
  }

 private:
  bool has_gates() const { return !ports_of(node_->description).gates; }
  void refuse(const json::Place& place, const char* message, const std::string& found, std::string expected) {
    if (told_.insert(place.pointer + found).second)  // generated nodes share theirs
      diagnostics_.error(place, message, {found + " at " + json::quote(node_->name), std::move(expected)});
  }
  void refuse_gates(const json::Place& place, const char* what) {
    refuse(place, "gates at a node without gates", what, "none, or no \"gates\": \"none\" of the node or its device");
  }

  void check_class(const json::Place& place, std::uint8_t traffic_class) {
    const std::uint8_t count = count_of(ports_of(node_->description).traffic_classes);
    if (traffic_class < count || traffic_class > 7) return;
    refuse(place, "a traffic class that the node does not have", "class " + std::to_string(traffic_class),
           count == 1 ? "class 0 alone" : "a class from 0 to " + std::to_string(count - 1));
  }
  void check_classes(const json::Source& where, std::string_view key, const std::vector<std::uint8_t>& classes) {
    for (std::size_t i = 0; i < classes.size(); ++i) check_class(where.at(key, i), classes[i]);
  }

  void check(const Egress& egress) {
    if (egress.gates && !has_gates()) refuse_gates(egress.where.at("gates"), "a gate list");
    for (const Shaper& shaper : egress.shapers) check_class(shaper.where.at("class"), shaper.traffic_class);
    for (const MaxSdu& max_sdu : egress.max_sdu) check_class(max_sdu.where.at("class"), max_sdu.traffic_class);
    for (const Share& share : egress.ets) check_class(share.where.at("class"), share.traffic_class);
    check_classes(egress.where, "ats", egress.ats);
    check_classes(egress.where, "cut_through", egress.cut_through);
    if (egress.preemption) check_classes(egress.preemption->where, "preemptable", egress.preemption->preemptable);
  }

  void check_cqf(const Cqf& cqf) {
    if (!has_gates()) refuse_gates(cqf.where.place(), "cyclic queuing, which is made of gates,");
    check_classes(cqf.where, "classes", cqf.classes);
  }

  void check(const SetGates& set) {
    const auto node = r_.topology.find(set.node);
    if (!node || r_.topology.nodes[*node].is_of_unknown_kind) return;
    node_ = &r_.topology.nodes[*node];
    if (!has_gates()) refuse_gates(set.where.at("node"), "a gate list");
  }

  const Resolved& r_;
  json::Diagnostics& diagnostics_;
  const TopologyNode* node_ = nullptr;
  std::set<std::string> told_;
};

}  // namespace

void check_port_abilities(const Resolved& resolved, json::Diagnostics& diagnostics) {
  AbilityCheck(resolved, diagnostics).run();
}

}  // namespace takt::scenario
