// SPDX-License-Identifier: Apache-2.0
#include "analysis/gate_beginning.hpp"

#include <algorithm>

#include "analysis/flow_graph.hpp"
#include "models/egress/cyclic_schedule.hpp"

namespace takt::analysis {

using sim::Duration;
using sim::LocalTime;

const ClockQuality& GateBeginning::quality_of(models::NodeIndex node) {
  if (node.value >= r_.plan.gptp.size() || !r_.plan.gptp[node.value]) return other_ = clock_quality(r_, node, options_);
  if (!of_gptp_) of_gptp_ = clock_quality(r_, node, options_);
  return *of_gptp_;
}

bool GateBeginning::is_over_at_the_start(models::NodeIndex node, LocalTime time) const {
  const models::NodePlan& plan = r_.plan.nodes[node.value];
  return time <= LocalTime() + (plan.clock ? plan.clock->initial_offset : Duration());
}

Duration GateBeginning::latest(models::NodeIndex node, LocalTime base_time, Duration cycle, Duration from) {
  const models::NodePlan& plan = r_.plan.nodes[node.value];
  if (!plan.clock) return models::first_cycle_from(LocalTime() + from, base_time, cycle).since_start();
  const ClockQuality& clock = quality_of(node);
  // What the clock shows when the list is read. One that gPTP sets right may have been set already, or not yet.
  LocalTime earliest = LocalTime() + plan.clock->initial_offset +
                       Duration::from_ps(scaled_down(from.ps(), one_ppt + clock.slowest_ppt, one_ppt));
  LocalTime last = LocalTime() + plan.clock->initial_offset +
                   Duration::from_ps(scaled_up(from.ps(), one_ppt + clock.fastest_ppt, one_ppt));
  if (clock.is_synchronised) {
    last = std::max(last, LocalTime() + from + Duration::from_ps(clock.error));
    // The clock shows the instant no later than its error after it, from when on it holds: that is an assumption of its
    // own.
    return std::max(from,
                    models::first_cycle_from(last, base_time, cycle).since_start() + Duration::from_ps(clock.error));
  }
  const Duration wait = earliest == last ? models::first_cycle_from(last, base_time, cycle) - last
                                         : std::max(base_time - earliest, base_time < last ? cycle : Duration());
  return from + Duration::from_ps(scaled_up(wait.ps(), one_ppt, one_ppt + clock.slowest_ppt));
}

Duration GateBeginning::latest_of_all() {
  Duration begin;
  const auto consider = [&](models::NodeIndex node, std::uint32_t port_config) {
    const auto& gates = r_.plan.port_configs[port_config].shaping.gates;
    if (gates) begin = std::max(begin, latest(node, *gates));
  };
  for (const models::LinkPlan& link : r_.plan.links)
    for (const models::LinkPlan::End* const end : {&link.a, &link.b})
      consider(end->node, end->port_config.value_or(r_.plan.nodes[end->node.value].port_config));
  for (std::uint32_t n = 0; n < r_.plan.nodes.size(); ++n) {
    if (!r_.plan.nodes[n].ingress) continue;
    for (const models::StreamGateConfig& gate : r_.plan.ingress_configs[*r_.plan.nodes[n].ingress].stream_gates)
      if (!gate.admin_control_list.empty()) begin = std::max(begin, latest(models::NodeIndex{n}, gate));
  }
  return begin;
}

}  // namespace takt::analysis
