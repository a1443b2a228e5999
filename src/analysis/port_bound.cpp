#include "analysis/port_bound.hpp"

#include <algorithm>
#include <limits>

#include "analysis/class_demand.hpp"
#include "analysis/gate_windows.hpp"
#include "analysis/scheduled_bound.hpp"
#include "models/egress/class_set.hpp"
#include "models/egress/preemption.hpp"
#include "models/ethernet/sizes.hpp"

namespace takt::analysis {
namespace {

using models::ClassSet;
using models::contains;
using models::TrafficClass;
using models::traffic_class_count;

/// Where the search for a fixed point gives up: delays beyond this are as good as unbounded.
constexpr Ps longest_search_ps = 100'000'000'000'000;   // 100 s
constexpr int most_steps = 100'000;
constexpr std::size_t most_bends = 20'000;
constexpr std::size_t most_jumps_of_others = 50;
/// Stretches in which work grows slower than the port sends are looked at so many times.
constexpr Ps looks_at_a_slope = 32;

class PortAnalysis {
 public:
  PortAnalysis(const PortModel& model, const PortTraffic& traffic)
      : model_(model), traffic_(traffic), config_(*model.config), octet_(model.octet_time), gap_(octet_ * models::inter_packet_gap.count) {
    bound_.flows.resize(traffic.flows.size());
    for (TrafficClass q = 0; q < traffic_class_count; ++q) demands_.emplace_back(traffic, models::with(0, q), octet_);
    shaped_rate_.fill(std::numeric_limits<double>::infinity());
    shaped_burst_.fill(std::numeric_limits<double>::infinity());
    if (config_.shaping.gates) gates_.emplace_back(with_hold(*config_.shaping.gates));
    for (const models::GateConfig& gates : model.more_gates) gates_.emplace_back(with_hold(gates));
  }

  PortBound run() {
    if (model_.cqf) bound_cqf();
    // Express classes first: preemptable ones wait for all of them.
    for (const bool preemptable : {false, true})
      for (TrafficClass q = traffic_class_count; q-- > 0;)
        if (is_preemptable(q) == preemptable) bound_class(q);
    return std::move(bound_);
  }

 private:
  bool is_preemptable(TrafficClass q) const { return config_.preemption && contains(config_.preemption->preemptable, q); }
  bool is_shaped(TrafficClass q) const { return config_.shaping.shapers[q].has_value(); }
  bool is_in_cqf(TrafficClass q) const { return model_.cqf && contains(model_.cqf->classes, q); }
  bool is_gated(TrafficClass q) const {
    return std::any_of(gates_.begin(), gates_.end(), [&](const GateCycle& gates) { return !gates.is_always_open(q); });
  }
  /// A frame of the class waits for nothing but other frames.
  bool is_work_conserving(TrafficClass q) const { return !is_shaped(q) && !is_gated(q) && !is_in_cqf(q); }
  bool overlap(TrafficClass a, TrafficClass b) const {
    if (holds_late_ && is_preemptable(a) != is_preemptable(b)) return true;
    return gates_.empty() || std::any_of(gates_.begin(), gates_.end(), [&](const GateCycle& gates) { return gates.overlap(a, b); });
  }
  /// Frames of h go before waiting ones of q.
  bool goes_before(TrafficClass h, TrafficClass q) const {
    if (is_preemptable(h) != is_preemptable(q)) return !is_preemptable(h);
    return h > q;
  }

  /// The longest frame of another class that may be under way when a frame of class q could start.
  Ps blocking(TrafficClass q) const {
    if (!model_.counts_packets) return 0;
    Ps longest = 0;
    for (TrafficClass other = 0; other < traffic_class_count; ++other) {
      if (other == q || demands_[other].is_empty() || goes_before(other, q)) continue;
      longest = std::max(longest, overlap(q, other) ? block_of(other, q) : gap_);
    }
    return longest;
  }
  /// For how long one frame of `other` keeps a frame of q from the medium.
  Ps block_of(TrafficClass other, TrafficClass q) const {
    const Ps frame = demands_[other].longest();
    if (!is_preemptable(other) || is_preemptable(q)) return frame;
    return std::min(frame, octet_ * models::longest_express_wait(config_.preemption->add_frag_size).count);
  }
  /// What of a window of q may be taken by a frame that began before it.
  Ps overhang(const GateCycle& gates, TrafficClass q) const {
    Ps longest = 0;
    for (TrafficClass other = 0; other < traffic_class_count; ++other) {
      if (demands_[other].is_empty()) continue;
      const bool counted_already = other == q || goes_before(other, q);
      longest = std::max(longest, counted_already ? gap_ : gates.overhang(q, other, block_of(other, q), gap_));
    }
    return longest;
  }

  /// What classes that go before q send in an interval of that length in which q waits: closed at its end.
  Ps interference(TrafficClass q, Ps length) const {
    Ps all = 0;
    for (TrafficClass h = 0; h < traffic_class_count; ++h) {
      const ClassDemand& demand = demands_[h];
      if (h == q || demand.is_empty() || !goes_before(h, q) || !overlap(q, h) || (is_in_cqf(h) && is_in_cqf(q))) continue;
      // Who has waited for a gate or for credit may have a backlog when the interval begins; but what is sent has come within its delay.
      const Ps reach = is_work_conserving(h) ? length : sum(length, class_delay_[h]);
      Ps work = demand.work(reach);
      if (is_shaped(h)) work = std::min(work, rounded_up(shaped_burst_[h] + shaped_rate_[h] * static_cast<double>(length)));
      if (is_preemptable(q) && !is_preemptable(h)) work = sum(work, product(octet_ * models::overhead_of_a_cut.count, std::min(demand.frames(reach), work / demand.shortest() + 1)));
      all = sum(all, work);
    }
    return all;
  }

  /// What cuts of frames of class q add in an interval of that length: each express frame makes one at most.
  Ps cuts(TrafficClass q, Ps length) const {
    if (!is_preemptable(q)) return 0;
    Ps all = 0;
    for (TrafficClass h = 0; h < traffic_class_count; ++h)
      if (!demands_[h].is_empty() && !is_preemptable(h))
        all = sum(all, product(octet_ * models::overhead_of_a_cut.count, demands_[h].frames(is_work_conserving(h) ? length : sum(length, class_delay_[h]))));
    return all;
  }
  /// From the first to the last bit of a frame that occupies the medium for `work`, which express frames may cut.
  Ps transmission(TrafficClass q, Ps work) const {
    Ps time = 0;
    for (int step = 0; step < most_steps && time <= longest_search_ps; ++step) {
      Ps next = sum(work - gap_, cuts(q, time));
      for (TrafficClass h = 0; h < traffic_class_count; ++h)
        if (!demands_[h].is_empty() && !is_preemptable(h)) next = sum(next, demands_[h].work(is_work_conserving(h) ? time : sum(time, class_delay_[h])));
      if (next <= time) return time;
      time = next;
    }
    return unbounded_ps;
  }

  struct Service {
    Ps blocked = 0;                          // by one frame, once
    std::vector<PeriodicSupply> windows;     // of each list; empty: always open
    bool is_shaped = false;
    double idle_share = 0;                   // of the port's rate while the gate is open
    double credit = 0;                       // the greatest, in time on the medium
  };

  Ps through_gates(const Service& service, Ps need) const {
    Ps longest = service.windows.empty() ? need : 0;
    for (const PeriodicSupply& windows : service.windows) longest = std::max(longest, windows.time_for(need));
    return longest;
  }

  /// When work that comes after `before` has been sent can start, counted from the start of a busy period. Unbounded if that is not found.
  Ps start(TrafficClass q, const Service& service, Ps before) const {
    if (!is_bounded(before)) return unbounded_ps;
    Ps time = 0;
    for (int step = 0; step < most_steps; ++step) {
      Ps need = service.is_shaped ? rounded_up((static_cast<double>(sum(before, cuts(q, time))) + service.credit) / service.idle_share)
                                  : sum(service.blocked, before, interference(q, time));
      if (contains(model_.unordered, q)) need = sum(need - std::min(before, need), std::max(before, demands_[q].work(time)));
      const Ps next = through_gates(service, need);
      if (next > longest_search_ps) return unbounded_ps;
      if (next <= time) return time;
      time = next;
    }
    return unbounded_ps;
  }

  /// Windows without the part in which the longest frame does not fit any more, and without what others may take of their starts.
  std::vector<PeriodicSupply> usable_windows(TrafficClass q) const {
    std::vector<PeriodicSupply> all;
    if (!is_gated(q)) return all;
    const Ps guard = model_.counts_packets ? demands_[q].longest() - gap_ : 0;
    for (const GateCycle& gates : gates_) {
      if (gates.is_always_open(q)) continue;
      const Ps hold = is_preemptable(q) ? hold_advance_ : 0;   // asked for so long before a window closes
      all.emplace_back(gates, q, overhang(gates, q) + model_.clock.error, guard + model_.clock.error + hold, model_.clock.rate_ppt);
    }
    return all;
  }
  /// While the MAC holds, the gates of preemptable classes are as good as closed.
  models::GateConfig with_hold(models::GateConfig gates) {
    if (!config_.preemption) return gates;
    bool holds = false;
    for (int round = 0; round < 2; ++round)   // the first one finds what the second one begins with
      for (models::GateControlEntry& entry : gates.admin_control_list) {
        if (entry.operation != models::GateOperation::set_gate_states) holds = entry.operation == models::GateOperation::set_and_hold_mac;
        if (round == 1 && holds) entry.gate_states = static_cast<models::GateStates>(entry.gate_states & ~config_.preemption->preemptable);
        holds_ = holds_ || holds;
      }
    const Ps longest_wait = octet_ * models::longest_express_wait(config_.preemption->add_frag_size).count;
    hold_advance_ = holds_ ? std::max(longest_wait, config_.preemption->hold_advance.value_or(sim::Duration()).ps()) : 0;
    holds_late_ = holds_ && config_.preemption->hold_advance && config_.preemption->hold_advance->ps() < longest_wait;
    return gates;
  }

  std::optional<Service> service_of(TrafficClass q, std::string& reason);
  bool make_shaped(TrafficClass q, Service& service, std::string& reason);
  void bound_class(TrafficClass q);
  void bound_flows(TrafficClass q, const Service& service, Ps busy);
  std::vector<Ps> waits_at_phases(TrafficClass q, const Service& service, Ps busy) const;
  void bound_cqf();
  void set_unbounded(TrafficClass q, std::string reason) { bound_.classes[q].reason = std::move(reason); }

  const PortModel& model_;
  const PortTraffic& traffic_;
  const models::PortConfig& config_;
  Ps octet_;
  Ps gap_;
  bool holds_ = false;          // some entry of a list does
  bool holds_late_ = false;     // a preemptable frame may reach into what is held
  Ps hold_advance_ = 0;
  std::vector<ClassDemand> demands_;
  std::vector<GateCycle> gates_;
  PortBound bound_;
  std::array<Ps, traffic_class_count> class_delay_{};
  std::array<double, traffic_class_count> shaped_rate_{};    // of each shaped class: what it sends in t is at most burst + rate * t
  std::array<double, traffic_class_count> shaped_burst_{};
};

/// Credit: from an instant with credit 0 and an empty queue, the class sends what the idle slope gives in the time its gate is open, less the credit that it has. That
/// is at most idle slope * N, where N is the longest time for which the class waits with credit: one frame of a lower class, and what goes before it.
bool PortAnalysis::make_shaped(TrafficClass q, Service& service, std::string& reason) {
  service.is_shaped = true;
  const double rate = 8e12 / static_cast<double>(octet_);
  const double admin = static_cast<double>(config_.shaping.shapers[q]->idle_slope.bits_per_second) / rate;
  double open_share = 1;
  double closed = 0;          // the most that the gate is closed beyond its long-run share
  double lost_share = 0;      // lost at ends of windows, in the long run and at once
  double lost = 0;
  const double guard = static_cast<double>(demands_[q].longest());
  if (gates_.size() > 1) {
    reason = "the gate list of a shaped class changes";
    return false;
  }
  for (const GateCycle& gates : gates_) {
    if (gates.is_always_open(q)) continue;
    const auto cycle = static_cast<double>(gates.cycle());
    open_share = static_cast<double>(gates.open(q)) / cycle;
    closed = cycle;
    const double loss = guard + static_cast<double>(overhang(gates, q) + 2 * model_.clock.error);
    lost_share = loss * static_cast<double>(gates.windows(q).size()) / cycle;
    lost = loss * static_cast<double>(gates.windows(q).size() + 1);
    service.windows.emplace_back(gates, q, model_.clock.error, model_.clock.error, model_.clock.rate_ppt);
  }
  const bool scales = config_.shaping.shapers[q]->of_whole_cycle;
  service.idle_share = scales ? admin / open_share : admin;
  const double whole_share = service.idle_share * open_share;
  double before_rate = lost_share;
  double before_burst = lost + static_cast<double>(std::max(blocking(q), demands_[q].longest()));
  if (model_.counts_packets && blocking(q) >= demands_[q].longest()) before_burst = lost + static_cast<double>(blocking(q));
  for (TrafficClass h = 0; h < traffic_class_count; ++h) {
    const ClassDemand& demand = demands_[h];
    if (h == q || demand.is_empty() || !goes_before(h, q) || !overlap(q, h)) continue;
    double h_rate = demand.rate();
    double h_burst = demand.burst();
    if (!is_work_conserving(h)) {
      if (is_shaped(h)) {
        h_rate = shaped_rate_[h];
        h_burst = shaped_burst_[h];
      } else {
        h_burst = is_bounded(class_delay_[h]) ? h_burst + h_rate * static_cast<double>(class_delay_[h]) : std::numeric_limits<double>::infinity();
      }
    }
    const bool cuts = is_preemptable(q) && !is_preemptable(h);
    const double more = cuts ? 1 + static_cast<double>(octet_ * models::overhead_of_a_cut.count) / static_cast<double>(demand.shortest()) : 1;
    before_rate += more * h_rate;
    before_burst += more * h_burst + (cuts ? static_cast<double>(octet_ * models::overhead_of_a_cut.count) : 0);
  }
  const double taken = before_rate / open_share;
  if (!(service.idle_share + taken <= 1 + 1e-12) || !(before_burst < 1e30) || taken >= 1) {
    reason = "the idle slope and what goes before the class use up the link";
    return false;
  }
  const double wait = (before_burst + before_rate * closed / open_share) / (1 - taken);
  service.credit = service.idle_share * wait;
  shaped_rate_[q] = whole_share;
  shaped_burst_[q] = service.credit + static_cast<double>(demands_[q].longest()) + service.idle_share * closed;
  return true;
}

std::optional<PortAnalysis::Service> PortAnalysis::service_of(TrafficClass q, std::string& reason) {
  Service service;
  if (is_shaped(q)) {
    if (contains(config_.shaping.timed, q)) {
      reason = "a class with a credit-based shaper and eligibility times";
      return std::nullopt;
    }
    if (!make_shaped(q, service, reason)) return std::nullopt;
    return service;
  }
  service.blocked = blocking(q);
  service.windows = usable_windows(q);
  return service;
}

void PortAnalysis::bound_class(TrafficClass q) {
  if (demands_[q].is_empty() || is_in_cqf(q)) return;
  PortClassBound& bound = bound_.classes[q];
  bound.is_used = true;
  class_delay_[q] = unbounded_ps;
  const std::optional<Service> service = service_of(q, bound.reason);
  if (!service) return;
  // In the long run there must be room, or the search for a busy period goes on for ever.
  double room = service->is_shaped ? service->idle_share : 1;
  for (const PeriodicSupply& windows : service->windows) room = std::min(room, windows.share() * (service->is_shaped ? service->idle_share : 1));
  double taken = demands_[q].rate();
  if (!service->is_shaped)
    for (TrafficClass h = 0; h < traffic_class_count; ++h)
      if (h != q && !demands_[h].is_empty() && goes_before(h, q) && overlap(q, h)) taken += is_shaped(h) ? std::min(shaped_rate_[h], demands_[h].rate()) : demands_[h].rate();
  if (!(taken <= room)) {
    bound.reason = taken < 1e300 ? "more comes than the class can send" : "a stream without a least gap between its frames";
    return;
  }
  // The longest busy period: until all that has come since its start is sent.
  Ps busy = 0;
  for (int step = 0; step < most_steps; ++step) {
    const Ps next = start(q, *service, demands_[q].work(busy));
    if (!is_bounded(next)) {
      bound.reason = "a class before it is unbounded, or the link is too full to tell";
      return;
    }
    if (next <= busy) break;
    busy = next;
  }
  bound_flows(q, *service, busy);
}

void PortAnalysis::bound_flows(TrafficClass q, const Service& service, Ps busy) {
  PortClassBound& bound = bound_.classes[q];
  const ClassDemand& demand = demands_[q];
  const Ps look_ahead = contains(config_.shaping.timed, q) ? model_.late_by : 0;
  const std::vector<Ps> bends = demand.bends(sum(busy, look_ahead), most_bends);
  std::vector<Ps> works;   // of frames, each once
  for (const PortFlow& flow : traffic_.flows)
    if (flow.lowest_class <= q && q <= flow.highest_class) works.push_back(octet_ * models::wire_length(flow.frame).count);
  std::sort(works.begin(), works.end());
  works.erase(std::unique(works.begin(), works.end()), works.end());
  std::vector<Ps> longest(works.size(), bends.empty() ? busy : 0);   // too many to look at: nobody waits for longer than a busy period
  // `at`: when the frame comes; `seen`: up to when others come before it, which is not earlier.
  const auto look = [&](Ps at, Ps seen) {
    for (std::size_t i = 0; i < works.size(); ++i) {
      const Ps last_bit = works[i] - gap_;
      const Ps all = demand.work(sum(seen, look_ahead));
      Ps done;
      if (is_preemptable(q) && service.is_shaped)
        done = sum(start(q, service, std::max<Ps>(0, all - works[i])), transmission(q, works[i]));
      else if (is_preemptable(q))
        done = start(q, service, std::max<Ps>(0, all - gap_));   // it may be cut until its last bit
      else
        done = sum(start(q, service, std::max<Ps>(0, all - works[i])), model_.counts_packets ? last_bit : 0);
      longest[i] = std::max(longest[i], is_bounded(done) ? done - at : unbounded_ps);
    }
  };
  for (std::size_t b = 0; b < bends.size(); ++b) {
    const Ps from = bends[b];
    const Ps until = b + 1 < bends.size() ? bends[b + 1] - 1 : std::max(busy, from);
    look(from, from);
    const double slope = demand.slope_after(from);
    if (slope >= 1) {
      look(until, until);
    } else if (slope > 0) {
      const Ps step = std::max<Ps>(1, (until - from) / looks_at_a_slope + 1);
      for (Ps at = from; at < until; at += step) look(at, std::min(at + step, until));
    }
  }
  const std::vector<Ps> waits = waits_at_phases(q, service, busy);
  class_delay_[q] = 0;
  for (std::size_t f = 0, scheduled = 0; f < traffic_.flows.size(); ++f) {
    const PortFlow& flow = traffic_.flows[f];
    if (q < flow.lowest_class || flow.highest_class < q || is_in_cqf(flow.highest_class)) continue;
    const auto work = static_cast<std::size_t>(std::lower_bound(works.begin(), works.end(), octet_ * models::wire_length(flow.frame).count) - works.begin());
    PortFlowBound& made = bound_.flows[f];
    const bool was_bounded_elsewhere = q != flow.highest_class;
    Ps delay = longest[work];
    if (!waits.empty() && flow.phase) delay = std::min(delay, sum(waits[scheduled++], works[work] - gap_));
    made.delay = was_bounded_elsewhere ? std::max(made.delay, delay) : delay;
    made.least_delay = model_.counts_packets ? works[work] - gap_ : 0;
    class_delay_[q] = std::max(class_delay_[q], delay);
  }
  if (!is_bounded(class_delay_[q])) {
    bound.reason = "the link is too full to tell";
    return;
  }
  // What is in the queue, or on the wire, has come within the longest delay and the gap behind the frame.
  bound.backlog = demand.work(sum(class_delay_[q], gap_));
  bound.backlog_frames = demand.frames(sum(class_delay_[q], gap_));
}

/// Where frames of a gated class come at known phases, on the time that the gates follow too: how long each of these flows waits. Empty otherwise.
std::vector<Ps> PortAnalysis::waits_at_phases(TrafficClass q, const Service& service, Ps busy) const {
  if (!is_gated(q) || service.is_shaped || is_preemptable(q) || contains(config_.shaping.timed, q) || !model_.clock.is_synchronised || !model_.counts_packets) return {};
  std::vector<ScheduledFlow> flows;
  std::vector<std::pair<const FrameArrivals*, Ps>> at_any_time;
  UnscheduledWork others;
  for (const PortFlow& flow : traffic_.flows) {
    if (q < flow.lowest_class || flow.highest_class < q || is_in_cqf(flow.highest_class)) continue;
    const Ps work = octet_ * models::wire_length(flow.frame).count;
    if (flow.phase) {
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
    const PhasedSupply windows(gates, q, gates.base(), overhang(gates, q) + error, demands_[q].longest() - gap_ + error);
    const StartFrom start = [&](Ps from, Ps before) {
      Ps time = 0;
      for (int step = 0; step < most_steps; ++step) {
        Ps need = sum(service.blocked, before);
        // The busy period begins with a frame of this class, so any other class may have a backlog then.
        for (TrafficClass h = 0; h < traffic_class_count; ++h)
          if (h != q && !demands_[h].is_empty() && goes_before(h, q) && overlap(q, h)) need = sum(need, demands_[h].work(sum(time, class_delay_[h])));
        const Ps next = windows.time_from(from, need);
        if (next > longest_search_ps) return unbounded_ps;
        if (next <= time) return time;
        time = next;
      }
      return unbounded_ps;
    };
    const std::optional<std::vector<Ps>> waits = longest_waits(flows, gates.cycle(), windows.ends(), busy, start, others);
    if (!waits) return {};
    for (std::size_t f = 0; f < flows.size(); ++f) longest[f] = std::max(longest[f], (*waits)[f]);
  }
  return longest;
}

/// What comes in a cycle is sent in the next one but (buffers - 2), if it fits.
void PortAnalysis::bound_cqf() {
  const CqfPort& cqf = *model_.cqf;
  const ClassDemand demand(traffic_, cqf.classes, octet_);
  if (demand.is_empty()) return;
  TrafficClass highest = 0;
  for (TrafficClass q = 0; q < traffic_class_count; ++q)
    if (is_in_cqf(q)) {
      bound_.classes[q].is_used = !demands_[q].is_empty();
      class_delay_[q] = unbounded_ps;
      highest = std::max(highest, q);
    }
  Ps needed = sum(cqf.forwarding_delay, demand.work(cqf.cycle), 2 * model_.clock.error);
  Ps blocked = 0;
  std::string reason = "what comes in a cycle does not fit into one";
  for (TrafficClass h = 0; h < traffic_class_count; ++h) {
    if (is_in_cqf(h) || demands_[h].is_empty()) continue;
    if (h > highest)
      needed = sum(needed, is_work_conserving(h) ? demands_[h].work(cqf.cycle) : unbounded_ps, demands_[h].longest());
    else
      blocked = std::max(blocked, demands_[h].longest());
  }
  const bool fits = sum(needed, blocked, gap_) <= cqf.cycle - cqf.dead_time;
  const bool all_use_it = std::all_of(traffic_.flows.begin(), traffic_.flows.end(), [&](const PortFlow& flow) { return flow.uses_cqf || (!is_in_cqf(flow.highest_class) && !is_in_cqf(flow.lowest_class)); });
  if (!all_use_it) reason = "frames that do not pass the stream gate share the classes of cyclic queuing and forwarding";
  if (!model_.clock.is_synchronised) reason = "cyclic queuing and forwarding on clocks that drift apart";
  const Ps delay = cqf.cycle * cqf.buffers - cqf.offset - cqf.dead_time - cqf.forwarding_delay + 2 * model_.clock.error;
  const Ps waits = std::max<Ps>(0, cqf.cycle * (cqf.buffers - 2) - cqf.offset - cqf.forwarding_delay - 2 * model_.clock.error);
  if (config_.preemption) reason = "cyclic queuing and forwarding with preemption";
  const bool holds = fits && all_use_it && model_.clock.is_synchronised && !config_.preemption;
  for (TrafficClass q = 0; q < traffic_class_count; ++q) {
    if (!is_in_cqf(q)) continue;
    if (!holds) {
      bound_.classes[q].reason = reason;
      continue;
    }
    class_delay_[q] = delay;
    bound_.classes[q].backlog = demand.work(delay);
    bound_.classes[q].backlog_frames = demand.frames(delay);
  }
  for (std::size_t f = 0; f < traffic_.flows.size(); ++f) {
    const PortFlow& flow = traffic_.flows[f];
    if (!is_in_cqf(flow.highest_class)) continue;
    const Ps last_bit = octet_ * models::wire_length(flow.frame).count - gap_;
    bound_.flows[f].delay = holds ? delay : unbounded_ps;
    bound_.flows[f].least_delay = last_bit + (holds ? waits : 0);
  }
}

}  // namespace

PortBound bound_port(const PortModel& model, const PortTraffic& traffic) { return PortAnalysis(model, traffic).run(); }

}  // namespace takt::analysis
