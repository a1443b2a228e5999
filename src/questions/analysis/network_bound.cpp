// SPDX-License-Identifier: Apache-2.0
#include "analysis/network_bound.hpp"

#include <algorithm>
#include <map>
#include <tuple>

#include "analysis/by_clock.hpp"
#include "analysis/cut_through_ports.hpp"
#include "analysis/cyclic_arrivals.hpp"
#include "analysis/flow_sources.hpp"
#include "models/egress/class_set.hpp"
#include "models/ethernet/sizes.hpp"
#include "sim/check.hpp"

namespace takt::analysis {
namespace {

/// More rounds than any sound network needs; what still grows then is taken for unbounded.
constexpr int most_rounds = 5000;

class FixedPoint {
 public:
  FixedPoint(const scenario::Resolved& resolved, const FlowGraph& graph, const std::function<bool()>& interrupted)
      : r_(resolved),
        graph_(graph),
        interrupted_(interrupted),
        arrivals_(graph.hops.size()),
        traffic_(graph.ports.size()),
        line_of_(graph.hops.size()),
        header_after_(graph.ports.size()),
        is_due_(graph.ports.size(), true),
        is_known_(graph.hops.size(), false) {
    result_.hops.resize(graph.hops.size());
    result_.ports.resize(graph.ports.size());
    for (const Hop& hop : graph.hops)
      if (hop.ats) ats_groups_[hop.ats->group].push_back(static_cast<std::uint32_t>(&hop - graph.hops.data()));
    for (std::uint32_t p = 0; p < graph.ports.size(); ++p) lay_out_traffic(p);
    for (std::uint32_t p = 0; p < graph.ports.size(); ++p) header_after_[p] = header_of_all(resolved, graph, p);
    for (std::uint32_t h = 0; h < graph.hops.size(); ++h) ahead_.push_back(header_ahead(resolved, graph, h));
  }

  NetworkResult run() {
    for (const Flow& flow : graph_.flows) expect_no_wait(flow);
    for (const Flow& flow : graph_.flows)
      for (const std::uint32_t hop : flow.hops) arrive(hop);
    // What still grows after many rounds is unbounded; with that known, the others settle.
    while (!settle()) abandon_diverging_flows();
    for (std::uint32_t p = 0; p < graph_.ports.size(); ++p) count_held_frames(p);
    for (std::uint32_t h = 0; h < graph_.hops.size(); ++h) result_.hops[h].may_drop = policing_drops(h);
    result_.arrivals = std::move(arrivals_);
    return std::move(result_);
  }

 private:
  /// Which flows come to a port, by which links; their arrival curves follow in each round.
  void lay_out_traffic(std::uint32_t p) {
    const GraphPort& port = graph_.ports[p];
    PortTraffic& traffic = traffic_[p];
    traffic.links.push_back({});  // no limit
    std::map<std::uint32_t, std::size_t> link_of;
    for (const std::uint32_t h : port.hops) {
      const Hop& hop = graph_.hops[h];
      PortFlow flow;
      flow.train = train_of(h);
      flow.rank = h;  // hops are made flow by flow, and those of copies in the order in which they leave the talker
      flow.frame = hop.frame;
      flow.shortest = hop.shortest;
      flow.lowest_class = hop.lowest_class;
      flow.highest_class = hop.highest_class;
      flow.uses_cqf = hop.uses_cqf;
      if (hop.parents.size() == 1 && !hop.is_copied_here) {
        const std::uint32_t from = graph_.hops[hop.parents.front()].port;
        const auto [known, is_new] = link_of.try_emplace(from, traffic.links.size());
        if (is_new) {
          const GraphPort& link = graph_.ports[from];
          IncomingLink incoming;
          // Where frames of one link take times of their own through the bridge, the last one may catch up with the
          // first.
          if (!link.may_double && !r_.plan.nodes[port.node.value].forwarding_jitter)
            incoming.octet_time = link.octet_time;
          incoming.is_mixed = graph_.models[from].config->preemption.has_value();
          traffic.links.push_back(incoming);
        }
        traffic.links[known->second].is_mixed = traffic.links[known->second].is_mixed || hop.headers_come_first;
        flow.link = known->second;
      }
      line_of_[h] = flow.link;
      traffic.flows.push_back(std::move(flow));
    }
    for (const GptpMessages& messages : gptp_messages(r_, port.node)) {
      PortFlow flow;
      flow.arrivals = messages.arrivals;
      flow.frame = messages.frame;
      flow.lowest_class = flow.highest_class = graph_.models[p].config->traffic_class_of_priority[7];
      traffic.flows.push_back(std::move(flow));
    }
  }

  /// Flows that left their talker one behind the other stay so, as long as they go the same way through one queue of
  /// each port.
  std::optional<std::uint32_t> train_of(std::uint32_t h) {
    const Hop& hop = graph_.hops[h];
    if (hop.parents.empty()) return graph_.flows[hop.flow].train;
    if (hop.parents.size() > 1 || hop.headers_come_first || is_held(hop)) return std::nullopt;
    const Hop& before = graph_.hops[hop.parents.front()];
    const std::optional<std::uint32_t> train = train_of(hop.parents.front());
    if (!train || before.lowest_class != before.highest_class ||
        graph_.models[before.port].config->shaping.is_timed(before.highest_class))
      return std::nullopt;
    return trains_
        .try_emplace({*train, before.port, before.highest_class},
                     static_cast<std::uint32_t>(graph_.flows.size() + graph_.hops.size() + trains_.size()))
        .first->second;
  }

  /// To begin with, frames that are planned come when the last of them would if nobody waited, which is what gates are
  /// laid for. Where gates keep frames for others that would come at other times, what follows would never get away
  /// from it.
  void expect_no_wait(const Flow& flow) {
    if (!flow.produced || flow.produced->clock != 0) return;
    const Ps last = sum(flow.produced->first + flow.produced->width, flow.worst_source);
    for (const std::uint32_t h : flow.hops) {
      const Hop& hop = graph_.hops[h];
      const GraphPort& port = graph_.ports[hop.port];
      Ps comes = last;
      for (const std::uint32_t parent : hop.parents)
        comes = sum(result_.hops[parent].leaves->first, graph_.ports[graph_.hops[parent].port].propagation, hop.beyond,
                    r_.plan.nodes[port.node.value].greatest_forwarding_delay().ps()) -
                ahead_[h].value_or(0);
      comes = sum(comes, copies_ahead(h));
      result_.hops[h].leaves =
          ArrivalPhase{sum(comes, port.octet_time * (models::wire_length(hop.frame) - models::inter_packet_gap).count),
                       flow.produced->period, 0};
    }
  }

  /// At the talker, how long the copies of a frame that leave before this one occupy the port, at least: they come at
  /// the same instant into the same queue, in the order of the hops.
  Ps copies_ahead(std::uint32_t h) const {
    const Hop& hop = graph_.hops[h];
    if (!hop.parents.empty() || hop.lowest_class != hop.highest_class) return 0;
    Ps ahead = 0;
    for (const std::uint32_t each : graph_.flows[hop.flow].hops) {
      const Hop& copy = graph_.hops[each];
      const bool is_before = each < h && copy.port == hop.port && copy.parents.empty() &&
                             copy.lowest_class == hop.lowest_class && copy.highest_class == hop.lowest_class;
      if (is_before) ahead += graph_.ports[hop.port].octet_time * models::wire_length(copy.shortest).count;
    }
    return ahead;
  }

  static bool is_held(const Hop& hop) { return hop.ats && hop.ats->is_minded; }

  bool settle() {
    for (int round = 0; round < most_rounds; ++round) {
      if (!one_round()) return true;
      ++result_.rounds;
    }
    return false;
  }

  bool one_round() {
    bool changed = false;
    const auto ports = static_cast<std::uint32_t>(graph_.ports.size());
    for (std::uint32_t at = 0; at < ports; ++at) {
      const std::uint32_t p = result_.rounds % 2 == 0 ? at : ports - 1 - at;  // to and fro, since paths lead both ways
      if (!is_due_[p] || graph_.ports[p].hops.empty()) continue;
      if (interrupted_ && interrupted_()) {
        result_.is_interrupted = true;
        return false;
      }
      is_due_[p] = false;
      ++result_.port_analyses;
      changed = true;
      const std::vector<std::uint32_t>& hops = graph_.ports[p].hops;
      for (std::size_t i = 0; i < hops.size(); ++i) {
        traffic_[p].flows[i].arrivals = arrivals_[hops[i]];
        // Frames that a scheduler has held come when they are eligible, not as their link brought them.
        traffic_[p].flows[i].link =
            is_held(graph_.hops[hops[i]]) && !result_.hops[hops[i]].is_never_held ? 0 : line_of_[hops[i]];
        traffic_[p].flows[i].phase = result_.hops[hops[i]].phase;
        const std::optional<CyclicArrival>& cyclic = result_.hops[hops[i]].cyclic;
        traffic_[p].flows[i].cyclic = cyclic ? std::optional(cyclic->comes) : std::nullopt;
      }
      std::optional<PortBound> cut = bound_cut_through(r_, graph_, p, traffic_[p], result_.hops, ahead_);
      const bool cuts = cut.has_value();
      result_.ports[p] = cuts ? std::move(*cut) : bound_port(graph_.models[p], traffic_[p]);
      for (std::size_t i = 0; i < hops.size(); ++i) {
        HopResult& hop = result_.hops[hops[i]];
        const PortFlowBound& bound = result_.ports[p].flows[i];
        if (header_after_[p]) {
          hop.delay = hop.least_delay = hop.reason.empty() ? *header_after_[p] : unbounded_ps;
          hop.leaves.reset();
          hop.cycle.reset();
          note_left(hops[i]);
          continue;
        }
        hop.delay = graph_.hops[hops[i]].unsupported.empty() && hop.reason.empty() ? bound.delay : unbounded_ps;
        hop.least_delay = std::min(hop.delay, sum(bound.least_delay, copies_ahead(hops[i])));
        if (const auto& ahead = ahead_[hops[i]]; cuts && ahead && is_bounded(hop.delay))
          hop.delay = hop.least_delay = hop.delay - *ahead;
        hop.leaves = is_bounded(hop.delay) ? bound.leaves : std::nullopt;
        hop.cycle = is_bounded(hop.delay) ? bound.cycle : std::nullopt;
        note_left(hops[i]);
      }
      // Schedulers that share a group wait for each other's frames, so all of them are looked at once all delays here
      // are known.
      for (const std::uint32_t h : hops)
        for (const std::uint32_t child : graph_.hops[h].children) {
          if (graph_.hops[child].ats)
            for (const std::uint32_t other : ats_groups_.at(graph_.hops[child].ats->group)) arrive(other);
          else
            arrive(child);
        }
    }
    return changed;
  }

  /// When and how a flow comes to a hop, from what is known of the hops before; its port is due if that has changed.
  void arrive(std::uint32_t h) {
    const Hop& hop = graph_.hops[h];
    const Flow& flow = graph_.flows[hop.flow];
    Ps best = flow.best_source;
    Ps worst = flow.worst_source;
    if (!hop.parents.empty()) {
      best = unbounded_ps;
      worst = 0;
      for (const std::uint32_t parent : hop.parents) {
        const HopResult& before = result_.hops[parent];
        const GraphPort& port = graph_.ports[graph_.hops[parent].port];
        const models::NodePlan& node = r_.plan.nodes[graph_.ports[hop.port].node.value];
        const Ps on_the_way = sum(port.propagation, hop.beyond, node.greatest_forwarding_delay().ps());
        const Ps at_least = sum(port.propagation, hop.beyond, node.least_forwarding_delay().ps());
        const bool may_be_cut = hop.headers_come_first && !header_after_[hop.port];
        best = std::min(
            best, may_be_cut ? sum(before.best, before_the_header(parent), at_least) : sum(before.best_left, at_least));
        worst = std::max(worst, is_held(hop) ? sum(before.worst, delay_with_hold(hop, parent), on_the_way)
                                             : sum(before.worst_left, on_the_way));
      }
    }
    HopResult& result = result_.hops[h];
    FrameArrivals arrivals;
    best = std::min(best, worst);
    const Ps own_jitter = is_bounded(worst) ? worst - best : unbounded_ps;
    if (hop.parents.size() == 1 && absorbs_jitter(hop.parents.front())) {
      // Late ones are less late behind gates, but a meter before them knows nothing of that: the arrival curve is that
      // of the talker.
      arrivals =
          flow.source.delayed(is_bounded(worst) ? own_jitter - (flow.worst_source - flow.best_source) : unbounded_ps);
    } else if (hop.parents.size() == 1) {
      const HopResult& before = result_.hops[hop.parents.front()];
      arrivals = arrivals_[hop.parents.front()].delayed(is_bounded(worst) ? own_jitter - (before.worst - before.best)
                                                                          : unbounded_ps);
    } else {
      arrivals = flow.source.delayed(hop.parents.empty() ? 0 : own_jitter);
      if (hop.parents.size() > 1 && !passes_once(flow, own_jitter))
        arrivals = multiplied(arrivals, static_cast<std::int64_t>(hop.parents.size()));
    }
    const ClockQuality& clock = graph_.models[hop.port].clock;
    if (hop.metered) arrivals.add(by_clock(*hop.metered, clock));
    if (is_held(hop)) arrivals.add(by_clock(hop.ats->shaped, clock));
    const std::optional<CyclicArrival> cyclic =
        is_held(hop) ? std::nullopt : cyclic_arrival(r_, graph_, result_.hops, h);
    if (cyclic)
      arrivals.add(by_clock(ArrivalPattern{cyclic->comes.period, cyclic->comes.frames, 0, cyclic->comes.width}, clock));
    const bool is_never_held = is_held(hop) && holds_nobody(hop);
    if (!hop.parents.empty() && graph_.ports[graph_.hops[hop.parents.front()].port].may_double)
      arrivals = multiplied(arrivals, 2);
    const std::optional<ArrivalPhase> phase = phase_of(h, best, worst);
    if (is_known_[h] && result.best == best && result.worst == worst && phase == result.phase &&
        cyclic == result.cyclic && is_never_held == result.is_never_held && same(arrivals, arrivals_[h]))
      return;
    is_known_[h] = true;
    result.best = best;
    result.worst = worst;
    result.phase = phase;
    result.cyclic = cyclic;
    result.is_never_held = is_never_held;
    note_left(h);
    arrivals_[h] = std::move(arrivals);
    is_due_[hop.port] = true;  // and with it the hops behind
  }

  /// From the arrival at a port to the first bit on the wire, at least. Frames that are always cut through begin before
  /// they have come.
  Ps before_the_header(std::uint32_t h) const {
    const GraphPort& port = graph_.ports[graph_.hops[h].port];
    const std::optional<Ps>& header = header_after_[graph_.hops[h].port];
    return header ? *header -
                        port.octet_time * (models::wire_length(graph_.hops[h].frame) - models::inter_packet_gap).count
                  : 0;
  }

  /// From production to the last bit: by the hops so far and this one, and by the schedule or the cycles of the port.
  void note_left(std::uint32_t h) {
    HopResult& hop = result_.hops[h];
    const std::optional<ArrivalPhase>& produced = graph_.flows[graph_.hops[h].flow].produced;
    hop.best_left = sum(hop.best, hop.least_delay);
    hop.worst_left = sum(hop.worst, hop.delay);
    if (hop.cycle && is_bounded(hop.worst)) {
      hop.best_left = std::max(hop.best_left, begins_at_least(hop) + hop.cycle->least_sent);
      hop.worst_left = std::min(hop.worst_left, begins_at_most(hop) + hop.cycle->greatest_sent);
    }
    if (!hop.leaves || !produced) return;
    const std::int64_t rate_ppt = graph_.models[graph_.hops[h].port].clock.rate_ppt;
    hop.worst_left =
        std::min(hop.worst_left, scaled_up(std::max<Ps>(0, hop.leaves->first + hop.leaves->width - produced->first),
                                           one_ppt + rate_ppt, one_ppt));
    hop.best_left =
        std::max(hop.best_left, scaled_down(std::max<Ps>(0, hop.leaves->first - produced->first - produced->width),
                                            one_ppt - rate_ppt, one_ppt));
  }
  /// The schedule or the cycles of the port say more than how long frames may be there.
  bool absorbs_jitter(std::uint32_t h) const {
    const HopResult& hop = result_.hops[h];
    return (hop.leaves || hop.cycle) &&
           (hop.worst_left < sum(hop.worst, hop.delay) || hop.best_left > sum(hop.best, hop.least_delay));
  }

  /// When the frames of a flow come to a hop, if that is known. A flow whose frames are doubled has no such times.
  std::optional<ArrivalPhase> phase_of(std::uint32_t h, Ps best, Ps worst) const {
    const Hop& hop = graph_.hops[h];
    const Flow& flow = graph_.flows[hop.flow];
    if (!flow.produced || !is_bounded(worst)) return std::nullopt;
    for (const std::uint32_t each : flow.hops) {
      if (graph_.ports[graph_.hops[each].port].may_double) return std::nullopt;
      const HopResult& known = result_.hops[each];
      const Ps jitter = is_bounded(known.worst) ? known.worst - known.best : unbounded_ps;
      if (graph_.hops[each].parents.size() > 1 && !passes_once(flow, jitter)) return std::nullopt;
    }
    // Clocks may drift a little on the way.
    const std::int64_t rate_ppt = std::max(graph_.models[hop.port].clock.rate_ppt, flow.produced->rate_ppt);
    const Ps drift = scaled_up(worst, rate_ppt, one_ppt);
    Ps first = flow.produced->first + best - drift;
    Ps last = sum(flow.produced->first + flow.produced->width, worst, drift);
    if (hop.parents.size() == 1 && !is_held(hop) && !hop.headers_come_first &&
        result_.hops[hop.parents.front()].leaves) {
      const ArrivalPhase& leaves = *result_.hops[hop.parents.front()].leaves;
      const models::NodePlan& node = r_.plan.nodes[graph_.ports[hop.port].node.value];
      const Ps propagation = sum(graph_.ports[graph_.hops[hop.parents.front()].port].propagation, hop.beyond);
      const Ps at_least = sum(propagation, node.least_forwarding_delay().ps());
      const Ps on_the_way = sum(propagation, node.greatest_forwarding_delay().ps());
      const Ps scheduled_first = leaves.first + scaled_down(at_least, one_ppt - rate_ppt, one_ppt);
      const Ps scheduled_last = sum(leaves.first + leaves.width, scaled_up(on_the_way, one_ppt + rate_ppt, one_ppt));
      // Both hold; while delays are still looked for they may not yet fit together.
      const bool fit_together = std::max(first, scheduled_first) <= std::min(last, scheduled_last);
      first = fit_together ? std::max(first, scheduled_first) : scheduled_first;
      last = fit_together ? std::min(last, scheduled_last) : scheduled_last;
    }
    return is_bounded(last) ? std::optional(ArrivalPhase{first, flow.produced->period, last - first,
                                                         flow.produced->clock, flow.produced->rate_ppt})
                            : std::nullopt;
  }

  static bool same(const FrameArrivals& a, const FrameArrivals& b) {
    return std::equal(a.patterns().begin(), a.patterns().end(), b.patterns().begin(), b.patterns().end(),
                      [](const ArrivalPattern& x, const ArrivalPattern& y) {
                        return x.period == y.period && x.frames == y.frames && x.gap == y.gap && x.jitter == y.jitter;
                      });
  }
  static FrameArrivals multiplied(const FrameArrivals& arrivals, std::int64_t copies) {
    FrameArrivals all;
    for (ArrivalPattern pattern : arrivals.patterns()) {
      pattern.frames *= copies;
      pattern.gap = 0;
      all.add(pattern);
    }
    return all;
  }
  /// Where the members of a stream meet, whose frames come within `spread` of each other: whether the recovery lets one
  /// copy of a frame through only. It forgets what has passed when its reset timer expires, and match recovery (IEEE
  /// 802.1CB, 7.4.3.5) as soon as another frame has come.
  bool passes_once(const Flow& flow, Ps spread) const {
    const auto redundancy =
        std::find_if(r_.redundancies.begin(), r_.redundancies.end(),
                     [&](const scenario::ResolvedRedundancy& each) { return each.stream == flow.stream; });
    if (redundancy == r_.redundancies.end()) return true;
    const scenario::Redundancy& description = *redundancy->description;
    if (!is_bounded(spread) || spread >= description.reset_timeout.ps()) return false;
    return description.algorithm != scenario::Recovery::match ||
           (flow.source.is_limited() && flow.source.count(spread) <= 1);
  }

  /// The delay at the port before, with what the scheduler of this hop holds the frame after it.
  Ps delay_with_hold(const Hop& hop, std::uint32_t parent) const {
    const Ps delay = result_.hops[parent].delay;
    if (!is_held(hop)) return delay;
    return std::min(sum(delay, hop.ats->longest_residence), delay_with_unlimited_hold(hop, parent));
  }

  /// The same if frames may be held for as long as it takes.
  ///
  /// A flow alone in its group that goes from a FIFO queue with delays up to D to its scheduler: if frame n waits for
  /// tokens, some frame m came to the queue at a(m), to the scheduler by a(m) + D, and the frames from m on need their
  /// tokens since. So it is held no longer than D and the longest time for which a scheduler before the queue would
  /// have held it; but also no longer than as it comes out of the link. Flows of one queue that share a group wait for
  /// each other: if all keep to their buckets before the queue, nobody is eligible later than D ("shaping for free", Le
  /// Boudec 2018); if not, each waits for what the others wait for, without end.
  Ps delay_with_unlimited_hold(const Hop& hop, std::uint32_t parent) const {
    const ClockQuality& clock = graph_.models[hop.port].clock;
    const Ps error = 2 * clock.error;
    const std::vector<std::uint32_t>& group = ats_groups_.at(hop.ats->group);
    const AtsHold& mine = *hop.ats;
    if (holds_nobody(hop)) return result_.hops[parent].delay;
    Ps least = unbounded_ps;
    const bool is_alone = std::all_of(group.begin(), group.end(), [&](std::uint32_t other) {
      return graph_.hops[other].flow == hop.flow && graph_.hops[other].parents == hop.parents;
    });
    if (is_alone && !mine.is_shared)
      least = sum(
          result_.hops[parent].delay,
          longest_hold(arrivals_at_scheduler(hop, parent), mine.bits, mine.burst_bits, slowest_rate(mine.rate, clock)),
          error);
    Ps longest = 0;
    Ps hold = 0;
    for (const std::uint32_t other : group) {
      const Hop& sibling = graph_.hops[other];
      if (sibling.parents.size() != 1 || sibling.ats->is_shared) return least;
      const Hop& before = graph_.hops[sibling.parents.front()];
      const Hop& queue = graph_.hops[parent];
      const PortModel& port = graph_.models[before.port];
      const bool one_queue = before.port == queue.port && before.highest_class == queue.highest_class &&
                             before.lowest_class == queue.lowest_class && before.lowest_class == before.highest_class;
      if (!one_queue || models::contains(port.unordered, before.highest_class) || graph_.ports[before.port].may_double)
        return least;
      longest = std::max(longest, result_.hops[sibling.parents.front()].delay);
      const AtsHold& its = *sibling.ats;
      if (clock.rate_ppt == 0 && port.clock.rate_ppt == 0 && error == 0 && port.clock.error == 0 &&
          is_shaped_alike(before, its))
        continue;
      hold = std::max(hold, longest_hold(arrivals_[sibling.parents.front()], its.bits, its.burst_bits,
                                         slowest_rate(its.rate, clock)));
    }
    if (!is_alone && (hold != 0 || error != 0)) return least;
    return std::min(least, sum(longest, hold, error));
  }

  /// All flows of the group keep to their buckets as they come to the schedulers: frames are eligible as they come.
  bool holds_nobody(const Hop& hop) const {
    const ClockQuality& clock = graph_.models[hop.port].clock;
    if (clock.error != 0) return false;
    const std::vector<std::uint32_t>& group = ats_groups_.at(hop.ats->group);
    return std::all_of(group.begin(), group.end(), [&](std::uint32_t other) {
      const Hop& sibling = graph_.hops[other];
      const AtsHold& its = *sibling.ats;
      return sibling.parents.size() == 1 && !its.is_shared &&
             !graph_.ports[graph_.hops[sibling.parents.front()].port].may_double &&
             longest_hold(arrivals_at_scheduler(sibling, sibling.parents.front()), its.bits, its.burst_bits,
                          slowest_rate(its.rate, clock)) == 0;
    });
  }

  /// The hop before has shaped the flow to a bucket that is no greater.
  static bool is_shaped_alike(const Hop& before, const AtsHold& bucket) {
    return is_held(before) && before.ats->bits == bucket.bits && before.ats->burst_bits <= bucket.burst_bits &&
           before.ats->rate <= bucket.rate;
  }

  /// The arrival curve of a flow where it comes out of the link before this hop.
  FrameArrivals arrivals_at_scheduler(const Hop& hop, std::uint32_t parent, bool metered = true) const {
    const HopResult& before = result_.hops[parent];
    FrameArrivals arrivals =
        arrivals_[parent].delayed(is_bounded(before.delay) ? before.delay - before.least_delay : unbounded_ps);
    if (hop.metered && metered) arrivals.add(by_clock(*hop.metered, graph_.models[hop.port].clock));
    // The link brings one frame after the other.
    const Hop& link = graph_.hops[parent];
    const GraphPort& port = graph_.ports[link.port];
    if (!port.may_double && !graph_.models[link.port].config->preemption && !hop.headers_come_first &&
        link.parents.size() <= 1)
      arrivals.add({port.octet_time * models::wire_length(link.shortest).count, 1, 0, 0});
    return arrivals;
  }

  /// Frames wait for their eligibility times in the queue: there they are from before the scheduler until they are
  /// sent.
  void count_held_frames(std::uint32_t p) {
    const auto waits_at_talker = [&](const Hop& hop) {
      return hop.parents.empty() && graph_.flows[hop.flow].waits > 0;
    };
    const auto held_in = [&](models::TrafficClass q) {
      return std::any_of(graph_.ports[p].hops.begin(), graph_.ports[p].hops.end(), [&](std::uint32_t h) {
        return (is_held(graph_.hops[h]) || waits_at_talker(graph_.hops[h])) && graph_.hops[h].highest_class == q;
      });
    };
    for (models::TrafficClass q = 0; q < models::traffic_class_count; ++q) {
      PortClassBound& bound = result_.ports[p].classes[q];
      if (!held_in(q) || !is_bounded(bound.backlog)) continue;
      Ps work = 0;
      std::int64_t frames = 0;
      for (const std::uint32_t h : graph_.ports[p].hops) {
        const Hop& hop = graph_.hops[h];
        if (q < hop.lowest_class || hop.highest_class < q) continue;
        FrameArrivals arrivals = arrivals_[h];
        Ps stays = sum(result_.hops[h].delay, models::inter_packet_gap.count * graph_.ports[p].octet_time);
        if (is_held(hop) && !hop.parents.empty()) {
          const std::uint32_t parent = hop.parents.front();
          arrivals = arrivals_at_scheduler(hop, parent);
          stays = sum(stays, delay_with_hold(hop, parent) - result_.hops[parent].least_delay);
        } else if (waits_at_talker(hop)) {
          arrivals = graph_.flows[hop.flow].handed_over;
          stays = sum(stays, graph_.flows[hop.flow].waits);
        }
        const bool is_known = arrivals.is_limited() && is_bounded(stays) && hop.parents.size() <= 1;
        const std::int64_t count = is_known ? arrivals.count(stays) : 0;
        work = is_known ? sum(work, product(graph_.ports[p].octet_time * models::wire_length(hop.frame).count, count))
                        : unbounded_ps;
        frames += count;
      }
      bound.backlog = work;
      bound.backlog_frames = frames;
    }
  }

  /// What the filter of the flow has in its way: a gate that may be closed, tokens that may lack, a scheduler that may
  /// hold it for too long.
  bool policing_drops(std::uint32_t h) const {
    const Hop& hop = graph_.hops[h];
    if (hop.parents.size() != 1) return !hop.parents.empty() && hop.policing.is_there;
    if (hop.policing.always_may_drop) return true;
    const std::uint32_t parent = hop.parents.front();
    const ClockQuality& clock = graph_.models[hop.port].clock;
    if (hop.policing.meter) {
      const TokenMeter& meter = *hop.policing.meter;
      FrameArrivals arrivals = arrivals_at_scheduler(hop, parent, false).delayed(2 * clock.error);
      if (!conforms(arrivals, std::int64_t{8} * graph_.hops[parent].frame.count, meter.burst_bits,
                    scaled_down(meter.rate, one_ppt + clock.slowest_ppt, one_ppt)))
        return true;
    }
    if (hop.ats && is_bounded(hop.ats->longest_residence)) {
      const Ps longest = is_held(hop) ? delay_with_unlimited_hold(hop, parent) : unbounded_ps;
      if (!is_bounded(longest) ||
          longest - result_.hops[parent].least_delay > hop.ats->longest_residence - 2 * clock.error)
        return true;
    }
    return false;
  }

  void abandon_diverging_flows() {
    for (std::uint32_t p = 0; p < graph_.ports.size(); ++p)
      if (is_due_[p])
        for (const std::uint32_t h : graph_.ports[p].hops)
          result_.hops[h].reason = "delays that depend on each other in a circle grow without end";
  }

  const scenario::Resolved& r_;
  const FlowGraph& graph_;
  const std::function<bool()>& interrupted_;
  std::vector<FrameArrivals> arrivals_;   // by hop
  std::vector<PortTraffic> traffic_;      // by port
  std::vector<std::size_t> line_of_;      // by hop: the link by which it comes to the port, in the port's traffic
  std::vector<std::optional<Ps>> ahead_;  // by hop: cut through, a frame begins so long before its last bit is there
  std::vector<std::optional<Ps>>
      header_after_;            // by port: all of its frames are cut through, so long after they have come
  std::vector<bool> is_due_;    // by port
  std::vector<bool> is_known_;  // by hop
  std::map<std::uint64_t, std::vector<std::uint32_t>> ats_groups_;
  std::map<std::tuple<std::uint32_t, std::uint32_t, models::TrafficClass>, std::uint32_t>
      trains_;  // behind a port, by the train before it, port and class
  NetworkResult result_;
};

}  // namespace

NetworkResult bound_network(const scenario::Resolved& resolved, const FlowGraph& graph,
                            const std::function<bool()>& interrupted) {
  return FixedPoint(resolved, graph, interrupted).run();
}

}  // namespace takt::analysis
