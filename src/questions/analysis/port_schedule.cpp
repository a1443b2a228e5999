// SPDX-License-Identifier: Apache-2.0
// Frames at known times: what the schedule of the gates makes of them, and, where there are no gates, who can meet
// whom.
#include <numeric>

#include "analysis/phased_bound.hpp"
#include "analysis/port_analysis.hpp"
#include "analysis/scheduled_bound.hpp"

namespace takt::analysis {

using models::contains;
using models::traffic_class_count;
using models::TrafficClass;

namespace {

constexpr std::size_t most_jumps_of_others = 50;

/// By the time that the gates follow.
bool is_at_known_time(const PortFlow& flow) { return flow.phase && flow.phase->clock == 0; }

}  // namespace

/// The windows of a class with what others may take of each: frames of classes whose gates are open when it opens, and
/// the gap behind those of others.
SequenceWindows PortAnalysis::windows_of(const GateCycle& gates, TrafficClass q, models::ClassSet elsewhere) const {
  SequenceWindows made;
  made.cycle = gates.cycle();
  made.base = gates.base();
  made.error = model_.clock.error;
  made.is_always_open = gates.is_always_open(q);
  const std::vector<Ps> taken =
      taken_at_starts(gates, q, false, elsewhere);  // each frame of its own counts with its gap
  for (std::size_t w = 0; w < taken.size(); ++w)
    made.windows.push_back({gates.windows(q)[w].from, gates.windows(q)[w].until, taken[w]});
  return made;
}

bool PortAnalysis::may_be_sequenced(TrafficClass q) const {
  return is_gated(q) && !is_shaped(q) && !is_preemptable(q) && !model_.cqf && !config_.shaping.is_timed(q) &&
         model_.clock.is_synchronised && model_.counts_packets;
}

/// The flows of a class all of whose frames come at known times.
std::optional<std::vector<SequencedFlow>> PortAnalysis::sequenced_flows(TrafficClass q, std::string& reason) const {
  std::vector<SequencedFlow> flows;
  bool are_known = true;
  for (const PortFlow& flow : traffic_.flows) {
    if (!is_in_class(flow, q)) continue;
    if (!is_at_known_time(flow) || flow.lowest_class != flow.highest_class) {
      are_known = false;
      continue;
    }
    const Ps work = octet_ * models::wire_length(flow.frame).count;
    flows.push_back({{flow.phase->first, flow.phase->period, flow.phase->width, stretched(work)},
                     stretched(work - gap_),
                     flow.train,
                     flow.rank});
  }
  if (are_known) return flows;
  if (!flows.empty()) reason = "others of its class come at times that are not known, and into its windows";
  return std::nullopt;
}

/// By each gate list of the port, the worst of all.
std::optional<SequenceBound> PortAnalysis::sequence_in_windows(TrafficClass q, const std::vector<SequencedFlow>& flows,
                                                               const OthersWork& others, models::ClassSet elsewhere,
                                                               std::string& reason) const {
  std::optional<SequenceBound> made;
  for (const GateCycle& gates : gates_) {
    const SequenceWindows windows = windows_of(gates, q, elsewhere);
    std::optional<SequenceBound> next = bound_sequence(flows, windows, others, reason);
    if (!next) return std::nullopt;
    if (!made) {
      made = std::move(next);
      continue;
    }
    for (std::size_t f = 0; f < flows.size(); ++f) {
      SequencedTimes& times = made->flows[f];
      times = {std::max(times.wait, next->flows[f].wait), std::min(times.earliest, next->flows[f].earliest),
               std::max(times.latest, next->flows[f].latest)};
    }
    made->backlog = std::max(made->backlog, next->backlog);
    made->backlog_frames = std::max(made->backlog_frames, next->backlog_frames);
    made->is_exact = made->is_exact && next->is_exact;
  }
  return made;
}

/// Classes that are open together, all of whose frames come at known times: each as if it were alone, if then no frame
/// is on the medium, or may start, while one of another class is. The first frame that met another one would have to
/// start as if alone, and so would the other one: so none does.
std::optional<SequenceBound> PortAnalysis::sequence_apart(TrafficClass q) const {
  if (config_.preemption) return std::nullopt;
  models::ClassSet together = models::with(0, q);
  for (bool grows = true; grows;) {
    grows = false;
    for (TrafficClass a = 0; a < traffic_class_count; ++a)
      for (TrafficClass b = 0; b < traffic_class_count && contains(together, a); ++b) {
        if (contains(together, b) || demands_[b].is_empty() || !overlap(a, b)) continue;
        together = models::with(together, b);
        grows = true;
      }
  }
  struct Occupied {
    TrafficClass of;
    Ps from, length, period;
  };
  std::vector<Occupied> all;
  std::optional<SequenceBound> own;
  std::string reason;
  for (TrafficClass c = 0; c < traffic_class_count; ++c) {
    if (!contains(together, c)) continue;
    const auto flows = may_be_sequenced(c) ? sequenced_flows(c, reason) : std::nullopt;
    if (!flows) return std::nullopt;
    auto alone = sequence_in_windows(c, *flows, {}, together, reason);
    if (!alone) return std::nullopt;
    for (std::size_t f = 0; f < flows->size(); ++f) {
      const SequencedTimes& times = alone->flows[f];
      const Ps from = (*flows)[f].first + times.earliest;
      all.push_back({c, from, times.latest - times.earliest + (*flows)[f].work, (*flows)[f].period});
    }
    if (c == q) own = std::move(alone);
  }
  for (const Occupied& a : all)
    for (const Occupied& b : all) {
      if (a.of >= b.of) continue;
      const Ps common = std::gcd(a.period, b.period);
      const Ps apart = ((b.from - a.from) % common + common) % common;
      if (a.length > apart || b.length > common - apart) return std::nullopt;
    }
  return own;
}

/// Where all frames of a gated class come at known times, on the time that the gates follow too: each into its window.
/// The reason if they may miss them.
std::optional<SequenceBound> PortAnalysis::sequence_of(TrafficClass q, std::string& reason) const {
  if (!may_be_sequenced(q)) return std::nullopt;
  const auto flows = sequenced_flows(q, reason);
  if (!flows) return std::nullopt;
  // A lower class may have begun a frame just before, and a higher one may have a backlog then.
  Ps blocked = 0;
  std::vector<TrafficClass> higher;
  for (TrafficClass other = 0; other < traffic_class_count; ++other) {
    if (other == q || demands_[other].is_empty() || !overlap(q, other)) continue;
    if (goes_before(other, q))
      higher.push_back(other);
    else
      blocked = std::max(blocked, block_of(other, q));
  }
  if (blocked == 0 && higher.empty()) return sequence_in_windows(q, *flows, {}, 0, reason);
  if (auto apart = sequence_apart(q)) return apart;
  const OthersWork others = [&](Ps length) {
    Ps all = blocked;
    for (const TrafficClass h : higher) all = sum(all, demands_[h].work(sum(length, class_delay_[h])));
    return stretched(all);
  };
  return sequence_in_windows(q, *flows, others, 0, reason);
}

/// Where frames of a gated class come at known phases, on the time that the gates follow too: how long each of these
/// flows waits. Empty otherwise.
std::vector<Ps> PortAnalysis::waits_at_phases(TrafficClass q, const Service& service, Ps busy) const {
  if (!is_gated(q) || service.is_shaped || is_preemptable(q) || config_.shaping.is_timed(q) ||
      !model_.clock.is_synchronised || !model_.counts_packets)
    return {};
  std::vector<ScheduledFlow> flows;
  std::vector<std::pair<const FrameArrivals*, Ps>> at_any_time;
  UnscheduledWork others;
  for (const PortFlow& flow : traffic_.flows) {
    if (!is_in_class(flow, q)) continue;
    const Ps work = octet_ * models::wire_length(flow.frame).count;
    if (is_at_known_time(flow)) {
      flows.push_back({flow.phase->first, flow.phase->period, flow.phase->width, work});
      continue;
    }
    if (!flow.arrivals.is_limited()) return {};
    at_any_time.emplace_back(&flow.arrivals, work);
    for (Ps jump = flow.arrivals.next_jump(0); jump <= busy; jump = flow.arrivals.next_jump(jump)) {
      others.jumps.push_back(jump);
      if (others.jumps.size() > most_jumps_of_others) return {};
    }
  }
  std::sort(others.jumps.begin(), others.jumps.end());
  others.in = [&](Ps length) {
    Ps all = 0;
    for (const auto& [arrivals, work] : at_any_time) all = sum(all, product(work, arrivals->count(length)));
    return all;
  };
  std::vector<Ps> longest(flows.size(), 0);
  for (const GateCycle& gates : gates_) {
    // Clocks that are off by their error, and drift while a frame waits.
    const Ps error = model_.clock.error + scaled_up(sum(gates.cycle(), busy), model_.clock.rate_ppt, 1'000'000'000'000);
    const PhasedSupply windows(gates, q, gates.base(), taken_at_starts(gates, q), error, demands_[q].longest() - gap_);
    const StartFrom start = [&](Ps from, Ps before) {
      Ps time = 0;
      for (int step = 0; step < most_steps; ++step) {
        Ps need = sum(service.blocked, before);
        // The busy period begins with a frame of this class, so any other class may have a backlog then.
        for (TrafficClass h = 0; h < traffic_class_count; ++h)
          if (h != q && !demands_[h].is_empty() && goes_before(h, q) && overlap(q, h))
            need = sum(need, demands_[h].work(sum(time, class_delay_[h])));
        const Ps next = windows.time_from(from, need);
        if (next > longest_search_ps) return unbounded_ps;
        if (next <= time) return time;
        time = next;
      }
      return unbounded_ps;
    };
    const std::optional<std::vector<Ps>> waits =
        longest_waits(flows, gates.cycle(), windows.ends(), busy, start, others);
    if (!waits) return {};
    for (std::size_t f = 0; f < flows.size(); ++f) longest[f] = std::max(longest[f], (*waits)[f]);
  }
  return longest;
}

/// A port that does nothing but send the highest class first, in which phases say who can meet whom.
bool PortAnalysis::phases_count(TrafficClass q) const {
  if (!gates_.empty() || config_.preemption || model_.cqf || !model_.counts_packets || model_.unordered != 0 ||
      config_.shaping.shared() != 0 || busy_[q] == 0 || !is_bounded(class_delay_[q]))
    return false;
  for (TrafficClass above = q; above < traffic_class_count; ++above)
    if (is_shaped(above) || config_.shaping.is_timed(above)) return false;
  return std::none_of(traffic_.links.begin(), traffic_.links.end(),
                      [](const IncomingLink& link) { return link.is_mixed; }) &&
         std::all_of(traffic_.flows.begin(), traffic_.flows.end(),
                     [](const PortFlow& flow) { return flow.lowest_class == flow.highest_class; });
}

/// The lesser of the bound with phases and that without, flow by flow; each clock's phases are known by that clock
/// alone.
void PortAnalysis::refine_by_phases(TrafficClass q) {
  if (demands_[q].is_empty() || !phases_count(q)) return;
  std::vector<std::uint32_t> clocks;
  for (const PortFlow& flow : traffic_.flows)
    if (flow.phase && is_in_class(flow, q) &&
        std::find(clocks.begin(), clocks.end(), flow.phase->clock) == clocks.end())
      clocks.push_back(flow.phase->clock);
  for (const std::uint32_t clock : clocks) {
    PhasedTraffic known;
    known.links = traffic_.links;
    known.octet_time = octet_;
    known.busy = busy_[q];
    for (std::size_t f = 0; f < traffic_.flows.size(); ++f) {
      const PortFlow& flow = traffic_.flows[f];
      const TrafficClass its = flow.highest_class;
      PhasedTraffic::Flow made;
      if (flow.phase && flow.phase->clock == clock) {
        made.phase = flow.phase;
        known.rate_ppt = std::max(known.rate_ppt, flow.phase->rate_ppt);
      }
      made.arrivals = &flow.arrivals;
      made.link = flow.link;
      made.role = its == q  ? PhasedTraffic::Role::own
                  : its > q ? PhasedTraffic::Role::before
                            : PhasedTraffic::Role::behind;
      made.work = octet_ * models::wire_length(flow.frame).count;
      made.stays = sum(bound_.flows[f].delay, gap_);
      known.flows.push_back(made);
    }
    const std::optional<std::vector<Ps>> waits = waits_by_phases(known);
    if (!waits) continue;
    for (std::size_t f = 0; f < traffic_.flows.size(); ++f)
      bound_.flows[f].delay = std::min(bound_.flows[f].delay, sum((*waits)[f], known.flows[f].work - gap_));
  }
  Ps longest = 0;
  for (std::size_t f = 0; f < traffic_.flows.size(); ++f)
    if (is_in_class(traffic_.flows[f], q)) longest = std::max(longest, bound_.flows[f].delay);
  if (longest >= class_delay_[q]) return;
  bound_.classes[q].backlog = std::min(bound_.classes[q].backlog, demands_[q].work(sum(longest, gap_)));
  bound_.classes[q].backlog_frames = std::min(bound_.classes[q].backlog_frames, demands_[q].frames(sum(longest, gap_)));
}

}  // namespace takt::analysis
