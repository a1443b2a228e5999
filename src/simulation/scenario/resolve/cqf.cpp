// SPDX-License-Identifier: Apache-2.0
#include "scenario/resolve/cqf.hpp"

#include <algorithm>

namespace takt::scenario {
namespace {

models::Priority priority_of(models::TrafficClass q, const ClassOfPriority& class_of_priority) {
  const auto found = std::find(class_of_priority.begin(), class_of_priority.end(), q);
  return static_cast<models::Priority>(found -
                                       class_of_priority.begin());  // each class has one: both mappings are one to one
}

}  // namespace

CqfTimes cqf_times(const Cqf& cqf, const Topology& topology, std::uint32_t node) {
  Duration longest;
  for (const models::LinkPlan& link : topology.links)
    if (link.a.node.value == node || link.b.node.value == node) longest = std::max(longest, link.delay);
  // A frame whose last bit comes at the very end of a cycle belongs to the next one.
  const Duration in_time = longest + Duration::from_ps(1'000);
  const bool two = cqf.classes.size() == 2;
  return {cqf.dead_time.value_or(two ? in_time : Duration()), cqf.offset.value_or(two ? Duration() : in_time)};
}

models::StreamGateConfig cqf_stream_gate(const Cqf& cqf, const CqfTimes& times,
                                         const ClassOfPriority& class_of_priority) {
  models::StreamGateConfig gate;
  gate.name = "cqf";
  for (const std::uint8_t q : cqf.classes)
    gate.admin_control_list.push_back({true, priority_of(q, class_of_priority), cqf.cycle, std::nullopt});
  gate.admin_cycle_time = cqf.cycle * static_cast<std::int64_t>(cqf.classes.size());
  gate.admin_base_time = sim::LocalTime() + cqf.base_time + times.offset;
  // Until then as in the cycle before.
  gate.admin_ipv = priority_of(cqf.classes.back(), class_of_priority);
  return gate;
}

models::GateConfig cqf_port_gates(const Cqf& cqf, const CqfTimes& times) {
  models::GateConfig gates;
  models::GateStates others = models::all_gates_open;
  for (const std::uint8_t q : cqf.classes) others = static_cast<models::GateStates>(others & ~(1u << q));
  for (std::size_t i = 0; i < cqf.classes.size(); ++i) {
    // While buffer i is filled, the one that was filled longest ago is sent from: the next in the circle.
    const std::uint8_t sent = cqf.classes[(i + 1) % cqf.classes.size()];
    gates.admin_control_list.push_back({models::GateOperation::set_gate_states,
                                        static_cast<models::GateStates>(others | 1u << sent),
                                        cqf.cycle - times.dead_time});
    if (times.dead_time > Duration())
      gates.admin_control_list.push_back({models::GateOperation::set_gate_states, others, times.dead_time});
  }
  gates.admin_cycle_time = cqf.cycle * static_cast<std::int64_t>(cqf.classes.size());
  gates.admin_base_time = sim::LocalTime() + cqf.base_time;
  return gates;
}

std::vector<models::Priority> cqf_priorities(const Cqf& cqf, const ClassOfPriority& class_of_priority) {
  std::vector<models::Priority> priorities(cqf.pcp.begin(), cqf.pcp.end());
  if (priorities.empty())
    for (const std::uint8_t q : cqf.classes) priorities.push_back(priority_of(q, class_of_priority));
  return priorities;
}

}  // namespace takt::scenario
