// SPDX-License-Identifier: Apache-2.0
#include "models/network.hpp"

namespace takt::models {

/// Hosts of which one process alone sends, all in one class, by a port that has nothing to decide.
void Network::find_single_talker_ports() {
  std::vector<std::uint32_t> senders(plan_.nodes.size());
  for (const auto& talker : talkers_) ++senders[traffic_.stream(talker->stream()).talker.value];
  for (const NodeIndex host : host_of_process_) ++senders[host.value];
  std::vector<const LinkPlan::End*> end_of(plan_.nodes.size());
  for (const LinkPlan& link : plan_.links)
    for (const LinkPlan::End* const end : {&link.a, &link.b})
      end_of[end->node.value] = end;                         // the only one where it counts
  std::vector<std::uint8_t> priorities(plan_.nodes.size());  // with which each node sends, bit p for priority p
  for (const StreamPlan& stream : plan_.streams)
    priorities[stream.talker.value] |= static_cast<std::uint8_t>(1u << stream.priority.value_or(0));
  for (std::size_t p = 0; p < processes_.size(); ++p) {
    const NodeIndex host = host_of_process_[p];
    if (senders[host.value] != 1 || !processes_[p]->sends_plainly() || !may_serve_one(*end_of[host.value])) continue;
    EgressPort& port = mutable_ports(host)[0];
    ClassSet classes = 0;
    for (unsigned priority = 0; priority < 8; ++priority)
      if ((priorities[host.value] >> priority & 1) != 0)
        classes = with(classes, port.config().traffic_class_of_priority[priority]);
    if (!is_one_class(classes)) continue;
    const TrafficClass q = highest_class(classes);
    if (!port.config().queue_limits[q].is_finite()) processes_[p]->send_by(port.serve_one(*simulation_, q));
  }
}

bool Network::may_serve_one(const LinkPlan::End& end) const {
  const std::span<const EgressPort> all = ports(end.node);
  return all.size() == 1 && !chooses_ports(end.node) && all[0].sends_plainly() && all[0].has_queues_only() &&
         shared_.link_local == nullptr && !end.gates_may_change;
}

}  // namespace takt::models
