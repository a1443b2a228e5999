// SPDX-License-Identifier: Apache-2.0
#include "analysis/separated_flow.hpp"

#include <algorithm>

#include "analysis/flow_sources.hpp"
#include "models/egress/class_set.hpp"
#include "models/ethernet/sizes.hpp"

namespace takt::analysis {
namespace {

/// Work on the medium of one port, in picoseconds: at most burst + rate * t in any closed interval of length t.
struct Bucket {
  double rate = 0;
  double burst = 0;
  void add(const FrameArrivals& arrivals, Ps work) {
    rate += arrivals.calmest().rate() * static_cast<double>(work);
    burst += arrivals.calmest().burst() * static_cast<double>(work);
  }
};

}  // namespace

/// In frames of the flow.
struct SeparatedFlows::Service {
  double rate = 0;     // a picosecond; 0: nothing is left
  double latency = 0;  // picoseconds
};

/// Why the port of this hop is no server of that kind to the flow.
std::string SeparatedFlows::objection(const Hop& hop) const {
  const PortModel& model = graph_.models[hop.port];
  const models::PortConfig& config = *model.config;
  if (!hop.unsupported.empty()) return hop.unsupported;
  if (config.shaping.gates || !model.more_gates.empty()) return "gates";
  if (config.preemption) return "preemption";
  if (config.shaping.shared() != 0) return "enhanced transmission selection";
  if (model.cqf) return "cyclic queuing and forwarding";
  if (hop.lowest_class != hop.highest_class) return "a stream in several classes";
  if (hop.parents.size() > 1 || hop.is_copied_here) return "copies for redundancy";
  if (hop.beyond > 0) return "a way over a bypass";
  if (hop.headers_come_first) return "cut-through";
  if (graph_.ports[hop.port].may_double) return "a link that doubles frames";
  for (const std::uint32_t h : graph_.ports[hop.port].hops) {
    const Hop& other = graph_.hops[h];
    for (models::TrafficClass q = std::max(hop.lowest_class, other.lowest_class); q <= other.highest_class; ++q) {
      if (config.shaping.shaper_of(q) != nullptr) return "a credit-based shaper";
      if (config.shaping.is_timed(q)) return "eligibility times";
    }
  }
  return {};
}

auto SeparatedFlows::left_over(std::uint32_t h) const -> Service {
  const Hop& mine = graph_.hops[h];
  const GraphPort& port = graph_.ports[mine.port];
  const auto work_of = [&](sim::Octets frame) { return port.octet_time * models::wire_length(frame).count; };
  Bucket higher;
  Bucket alike;
  Ps blocking = 0;
  bool is_limited = true;
  const bool waits = graph_.models[mine.port].counts_packets;
  const auto block = [&](Ps work) { blocking = waits ? std::max(blocking, work) : 0; };
  const auto meet = [&](const FrameArrivals& arrivals, sim::Octets frame, models::TrafficClass lowest,
                        models::TrafficClass highest) {
    if (lowest < mine.highest_class) block(work_of(frame));
    if (highest < mine.highest_class) return;
    is_limited = is_limited && arrivals.is_limited();
    if (arrivals.is_limited()) (lowest > mine.highest_class ? higher : alike).add(arrivals, work_of(frame));
  };
  for (const std::uint32_t other : port.hops)
    if (other != h)
      meet(network_.arrivals[other], graph_.hops[other].frame, graph_.hops[other].lowest_class,
           graph_.hops[other].highest_class);
  const models::TrafficClass gptp_class = graph_.models[mine.port].config->traffic_class_of_priority[7];
  for (const GptpMessages& messages : gptp_messages(r_, port.node))
    meet(messages.arrivals, messages.frame, gptp_class, gptp_class);
  const double rate = 1 - higher.rate;
  if (!is_limited || rate - alike.rate <= 0) return {};
  const double latency = (static_cast<double>(blocking) + higher.burst) / rate;
  return {(rate - alike.rate) / static_cast<double>(work_of(mine.frame)), latency + alike.burst / rate};
}

SeparatedFlowBound SeparatedFlows::bound(std::uint32_t last) const {
  const Flow& flow = graph_.flows[graph_.hops[last].flow];
  double slowest = 0;
  double latency = 0;
  Ps on_the_way = flow.worst_source;
  for (std::uint32_t h = last;; h = graph_.hops[h].parents.front()) {
    const Hop& hop = graph_.hops[h];
    const GraphPort& port = graph_.ports[hop.port];
    const auto at = [&] { return " at " + r_.plan.nodes[port.node.value].name + ":" + std::to_string(port.number); };
    if (const std::string reason = objection(hop); !reason.empty()) return {unbounded_ps, reason + at()};
    const Service service = left_over(h);
    if (service.rate <= 0) return {unbounded_ps, "others leave nothing" + at()};
    slowest = slowest == 0 ? service.rate : std::min(slowest, service.rate);
    latency += service.latency + (h == last || !graph_.models[hop.port].counts_packets ? 0 : 1 / service.rate);
    on_the_way = sum(on_the_way, port.propagation);
    if (hop.parents.empty()) break;
    on_the_way = sum(on_the_way, r_.plan.nodes[port.node.value].greatest_forwarding_delay().ps());
  }
  if (!flow.source.is_limited()) return {unbounded_ps, "no least gap between its frames"};
  const ArrivalPattern& arrivals = flow.source.calmest();
  if (arrivals.rate() > slowest) return {unbounded_ps, "more comes than is left"};
  // The gap behind the last frame is nobody's delay.
  const Ps gap = graph_.ports[graph_.hops[last].port].octet_time * models::inter_packet_gap.count;
  return {sum(rounded_up(latency + arrivals.burst() / slowest), on_the_way) - gap, {}};
}

}  // namespace takt::analysis
