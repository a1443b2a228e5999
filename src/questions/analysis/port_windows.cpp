// SPDX-License-Identifier: Apache-2.0
// A class that has the windows of its gate before all others: how long its frames take if they are counted window by
// window.
#include "analysis/packed_windows.hpp"
#include "analysis/port_analysis.hpp"

namespace takt::analysis {

using models::contains;
using models::traffic_class_count;
using models::TrafficClass;

/// By flow of the port; empty if there is none. Arrivals count by their calmest patterns alone, whatever links say,
/// frames as if all were the longest: shorter ones, and those that do not come, leave all others where they are or
/// before.
std::vector<Ps> PortAnalysis::delays_in_windows(TrafficClass q) const {
  if (!is_gated(q) || is_shaped(q) || config_.preemption || model_.cqf || config_.shaping.is_timed(q) ||
      contains(config_.cut_through, q) || !model_.counts_packets)
    return {};
  for (TrafficClass h = 0; h < traffic_class_count; ++h)
    if (h != q && !demands_[h].is_empty() && goes_before(h, q) && overlap(q, h)) return {};
  std::vector<PackedFlow> flows;
  for (const PortFlow& flow : traffic_.flows) {
    if (!is_in_class(flow, q)) continue;
    if (!flow.arrivals.is_limited()) return {};
    const ArrivalPattern& calm = flow.arrivals.calmest();
    if (calm.frames != 1) return {};
    flows.push_back({octet_ * models::wire_length(flow.frame).count, calm.period, calm.jitter});
  }
  const Ps error = model_.clock.error;
  const auto at_least = [&](Ps length) {
    return scaled_down(std::max<Ps>(0, length), one_ppt, one_ppt + model_.clock.fastest_ppt);
  };
  const auto at_most = [&](Ps length) {
    return scaled_up(std::max<Ps>(0, length), one_ppt, one_ppt + model_.clock.slowest_ppt);
  };
  std::vector<Ps> longest(flows.size(), 0);
  for (const GateCycle& gates : gates_) {
    if (gates.is_always_open(q)) return {};
    const std::vector<GateOpening>& all = gates.windows(q);
    const std::vector<Ps> taken = taken_at_starts(gates, q);
    PackedWindows made{{},
                       std::max(blocking(q), gap_),
                       gap_};  // the gap behind a higher class whose window has just closed counts too
    for (std::size_t w = 0; w < all.size(); ++w) {
      const GateOpening& window = all[w];
      const Ps lost = taken[w] + error;
      const Ps lost_of_next = taken[(w + 1) % all.size()] + error;
      const Ps next = w + 1 < all.size() ? all[w + 1].from : all.front().from + gates.cycle();
      made.windows.push_back(
          {at_least(window.until - error - window.from - lost), at_most(window.until - window.from + 2 * error),
           at_most(next + lost_of_next - window.from - lost), at_most(next + lost_of_next - window.until + error)});
    }
    const std::optional<std::vector<Ps>> delays = delays_of_packed(flows, made);
    if (!delays) return {};
    for (std::size_t f = 0; f < flows.size(); ++f) longest[f] = std::max(longest[f], (*delays)[f]);
  }
  std::vector<Ps> delays(traffic_.flows.size(), unbounded_ps);
  for (std::size_t f = 0, counted = 0; f < traffic_.flows.size(); ++f)
    if (is_in_class(traffic_.flows[f], q)) delays[f] = longest[counted++];
  return delays;
}

}  // namespace takt::analysis
