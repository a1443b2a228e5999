// SPDX-License-Identifier: Apache-2.0
#include "analysis/cyclic_arrivals.hpp"

#include <algorithm>

namespace takt::analysis {

std::optional<CyclicArrival> cyclic_arrival(const scenario::Resolved& r, const FlowGraph& graph,
                                            const std::vector<HopResult>& hops, std::uint32_t h) {
  const Hop& hop = graph.hops[h];
  if (hop.parents.size() != 1 || hop.headers_come_first) return std::nullopt;
  const HopResult& before = hops[hop.parents.front()];
  const GraphPort& link = graph.ports[graph.hops[hop.parents.front()].port];
  if (!before.cycle || link.may_double || !is_bounded(before.worst)) return std::nullopt;
  const models::NodePlan& node = r.plan.nodes[graph.ports[hop.port].node.value];
  const std::int64_t rate_ppt = graph.models[hop.port].clock.rate_ppt;
  const Ps propagation = sum(link.propagation, hop.beyond);
  const Ps at_least = scaled_down(sum(propagation, node.least_forwarding_delay().ps()), one_ppt - rate_ppt, one_ppt);
  const Ps at_most = scaled_up(sum(propagation, node.greatest_forwarding_delay().ps()), one_ppt + rate_ppt, one_ppt);
  CyclicFrames comes = before.cycle->leaves;
  comes.first += at_least;
  comes.width = sum(comes.width, at_most - at_least);
  return CyclicArrival{comes, begins_at_least(before), begins_at_most(before)};
}

Ps begins_at_least(const HopResult& hop) {
  const Ps by_wait = hop.best + hop.cycle->least_wait;
  return hop.cyclic && hop.cycle->follows ? std::max(by_wait, hop.cyclic->best + hop.cycle->least_step) : by_wait;
}

Ps begins_at_most(const HopResult& hop) {
  const Ps by_wait = hop.worst + hop.cycle->greatest_wait;
  return hop.cyclic && hop.cycle->follows ? std::min(by_wait, hop.cyclic->worst + hop.cycle->greatest_step) : by_wait;
}

}  // namespace takt::analysis
