// SPDX-License-Identifier: Apache-2.0
#include "analysis/port_bound.hpp"

#include <numeric>

#include "analysis/port_analysis.hpp"

namespace takt::analysis {

using models::contains;
using models::traffic_class_count;
using models::TrafficClass;

namespace {

constexpr std::size_t most_bends = 20'000;
/// Stretches in which work grows slower than the port sends are looked at so many times.
constexpr Ps looks_at_a_slope = 32;
/// Instants at which the credit of a shaper is looked at.
constexpr std::size_t most_peaks = 300;

}  // namespace

/// Credit: from an instant with credit 0 and an empty queue, the class sends what the idle slope gives in the time its
/// gate is open, less the credit that it has. That is at most idle slope * N, where N is the longest time for which the
/// class waits with credit: one frame of a lower class, and what goes before it.
bool PortAnalysis::make_shaped(TrafficClass q, Service& service, std::string& reason) {
  service.is_shaped = true;
  const double rate = 8e12 / static_cast<double>(octet_);
  const double admin = static_cast<double>(config_.shaping.shaper_of(q)->idle_slope.bits_per_second) / rate;
  double open_share = 1;
  double closed = 0;      // the most that the gate is closed beyond its long-run share
  double lost_share = 0;  // lost at ends of windows, in the long run and at once
  double lost = 0;
  const auto longest = static_cast<double>(demands_[q].longest());
  if (gates_.size() > 1) {
    reason = "the gate list of a shaped class changes";
    return false;
  }
  for (const GateCycle& gates : gates_) {
    if (gates.is_always_open(q)) continue;
    const auto cycle = static_cast<double>(gates.cycle());
    open_share = static_cast<double>(gates.open(q)) / cycle;
    closed = cycle;
    const double loss = longest + static_cast<double>(overhang(gates, q) + 2 * model_.clock.error);
    lost_share = loss * static_cast<double>(gates.windows(q).size()) / cycle;
    lost = loss * static_cast<double>(gates.windows(q).size() + 1);
    service.windows.emplace_back(gates, q, std::vector<Ps>(gates.windows(q).size(), 0), model_.clock.error, 0,
                                 model_.clock.slowest_ppt, model_.clock.fastest_ppt);
  }
  const bool scales = config_.shaping.shaper_of(q)->of_whole_cycle;
  service.idle_share = scales ? admin / open_share : admin;
  const double whole_share = service.idle_share * open_share;
  // With gates, and where frames are cut, classes before it may have credit when it begins to wait.
  const bool is_plain = service.windows.empty() && !config_.preemption;
  Line before = what_goes_before(q, is_plain);
  before.rate += lost_share;
  before.burst += lost;
  const double taken = before.rate / open_share;
  if (!(service.idle_share + taken <= 1 + 1e-12) || !(before.burst < 1e30) || taken >= 1) {
    reason = "the idle slope and what goes before the class use up the link";
    return false;
  }
  if (is_plain) {
    service.credit =
        std::min(credit_of_line(q, service.idle_share, before), greatest_credit(q, service.idle_share, before));
  } else {
    const auto block = static_cast<double>(model_.counts_packets && blocking(q) >= demands_[q].longest()
                                               ? blocking(q)
                                               : std::max(blocking(q), demands_[q].longest()));
    service.credit = service.idle_share * (block + before.burst + before.rate * closed / open_share) / (1 - taken);
    if (service.windows.empty())
      service.credit =
          std::min(service.credit, greatest_credit(q, service.idle_share, {before.rate, before.burst + block}));
  }
  shaped_rate_[q] = whole_share;
  // Credit is what it is at most when an interval begins, and what one frame costs is the least that is left when it
  // ends.
  shaped_burst_[q] = service.credit + (is_plain ? 1 - service.idle_share : 1) * longest + service.idle_share * closed;
  burst_behind_block_[q] = is_plain ? (1 - service.idle_share) * longest : shaped_burst_[q];
  return true;
}

PortAnalysis::Line PortAnalysis::what_goes_before(TrafficClass q, bool is_behind_block) const {
  Line before;
  for (TrafficClass h = 0; h < traffic_class_count; ++h) {
    const ClassDemand& demand = demands_[h];
    if (h == q || demand.is_empty() || !goes_before(h, q) || !overlap(q, h)) continue;
    double h_rate = demand.rate();
    double h_burst = demand.burst();
    if (is_shaped(h)) {
      h_rate = shaped_rate_[h];
      h_burst = is_behind_block ? burst_behind_block_[h] : shaped_burst_[h];
    } else if (!is_work_conserving(h)) {
      h_burst = is_bounded(class_delay_[h]) ? h_burst + h_rate * static_cast<double>(class_delay_[h])
                                            : std::numeric_limits<double>::infinity();
    }
    const bool cuts = is_preemptable(q) && !is_preemptable(h);
    const double more = cuts ? 1 + static_cast<double>(octet_ * models::overhead_of_a_cut.count) /
                                       static_cast<double>(demand.shortest())
                             : 1;
    before.rate += more * h_rate;
    before.burst += more * h_burst + (cuts ? static_cast<double>(octet_ * models::overhead_of_a_cut.count) : 0);
  }
  return before;
}

/// The longest frame of its own behind which the class may come to more credit than ever before: it costs (1 - i) l,
/// and what goes before sends (r l + b) / (1 - r) since it began, for i times as much credit. Nothing if no frame is as
/// short as that.
double PortAnalysis::longest_own_block(TrafficClass q, double idle_share, const Line& before) const {
  const auto longest = static_cast<double>(demands_[q].longest());
  const double spare = 1 - idle_share - before.rate;
  const double most = spare > 1e-9 ? std::min(longest, idle_share * before.burst / spare * (1 + 1e-9)) : longest;
  return most < static_cast<double>(demands_[q].shortest()) ? 0 : most;
}

/// The greatest credit by lines. When the class begins to have credit and to wait, behind one frame of a lower class or
/// of its own, none of those before it has credit: so in t after that frame began each shaped one sends at most (1 -
/// slope) * frame + slope * t (de Azua and Boyer, RTNS 2014, with frames of one's own).
double PortAnalysis::credit_of_line(TrafficClass q, double idle_share, const Line& before) const {
  const double lower = (static_cast<double>(blocking(q)) + before.burst) / (1 - before.rate);
  const double own = (before.rate * longest_own_block(q, idle_share, before) + before.burst) / (1 - before.rate);
  return idle_share * std::max(lower, own);
}

/// The greatest credit, interval by interval. Let the class wait with credit, and let the classes before it be busy
/// since L. They have sent T(L) = min over s of (B + what comes to them in s) + L - s, no more than L; in the rest of L
/// this class sends. So its credit is at most T(L) - (1 - i) L, and less by i * B if what began before them was a frame
/// of its own, which costs credit.
double PortAnalysis::greatest_credit(TrafficClass q, double idle_share, const Line& before) const {
  const bool is_behind_block = !config_.preemption;
  const Ps own_block = is_behind_block ? rounded_up(longest_own_block(q, idle_share, before)) : demands_[q].longest();
  double greatest = 0;
  for (const bool begins_with_own : {false, true}) {
    if (begins_with_own && longest_own_block(q, idle_share, before) <= 0 && is_behind_block) continue;
    const Ps block = !model_.counts_packets ? 0
                     : begins_with_own      ? std::min(own_block, demands_[q].longest())
                                            : blocking(q);
    const double offset = begins_with_own ? idle_share * static_cast<double>(block) : 0;
    Ps first = block;  // the end of the first busy period of the others
    for (int step = 0;; ++step) {
      const Ps next = sum(block, interference(q, first, is_behind_block));
      if (step == most_steps || next > longest_search_ps) return std::numeric_limits<double>::infinity();
      if (next <= first) break;
      first = next;
    }
    greatest = std::max(greatest, idle_share * static_cast<double>(first) - offset);
    // Later peaks are lower than the line above all of them, which falls.
    if (1 - idle_share - before.rate < 1e-6) return std::numeric_limits<double>::infinity();
    const double last =
        (static_cast<double>(block) + before.burst - greatest - offset) / (1 - idle_share - before.rate);
    if (!(last < static_cast<double>(longest_search_ps))) return std::numeric_limits<double>::infinity();
    const Ps end = rounded_up(std::max(0.0, last));
    std::vector<Ps> instants{first, std::max(first, end)};
    for (TrafficClass h = 0; h < traffic_class_count; ++h) {
      if (h == q || demands_[h].is_empty() || !goes_before(h, q)) continue;
      const Ps later = is_work_conserving(h) ? 0 : class_delay_[h];
      if (!is_bounded(sum(end, later))) return std::numeric_limits<double>::infinity();
      const std::vector<Ps> bends = demands_[h].bends(sum(end, later), most_peaks);
      if (bends.empty()) return std::numeric_limits<double>::infinity();
      for (const Ps bend : bends)
        if (bend - later > first && bend - later < end) instants.push_back(bend - later);
    }
    std::sort(instants.begin(), instants.end());
    Ps sent = first;
    for (std::size_t i = 0; i + 1 < instants.size(); ++i)
      for (Ps from = instants[i], step = (instants[i + 1] - from) / looks_at_a_slope + 1; from < instants[i + 1];
           from += step) {
        const Ps until = std::min(from + step, instants[i + 1]);
        // Up to just before `until` no more is there to be sent than this.
        const Ps there = sum(block, interference(q, until - 1, is_behind_block));
        const Ps peak = std::min(until, from + std::max<Ps>(0, there - sent));
        sent = std::min(sent + (peak - from), there);
        greatest =
            std::max(greatest, static_cast<double>(sent) - (1 - idle_share) * static_cast<double>(peak) - offset);
      }
  }
  return greatest + 1;  // a picosecond, for what floating point rounds
}

/// The least that frames of the class, and of those before it, fill of a window while some of them wait all the time:
/// frame behind frame until one does not fit into what is left.
Ps PortAnalysis::packed(TrafficClass q, Ps room) const {
  constexpr std::size_t most_sums = 500;
  std::vector<Ps> works;
  Ps longest = 0;
  for (const PortFlow& flow : traffic_.flows) {
    const bool counts =
        is_in_class(flow, q) || std::any_of(demands_.begin(), demands_.end(), [&](const ClassDemand& demand) {
          const auto h = static_cast<TrafficClass>(&demand - demands_.data());
          return h != q && is_in_class(flow, h) && goes_before(h, q) && overlap(q, h);
        });
    if (!counts) continue;
    works.push_back(octet_ * models::wire_length(flow.frame).count);
    longest = std::max(longest, works.back());
  }
  std::sort(works.begin(), works.end());
  works.erase(std::unique(works.begin(), works.end()), works.end());
  const Ps enough = room - (longest - gap_) + 1;  // with so much of it gone the longest frame does not fit
  if (works.empty() || enough <= 0) return std::max<Ps>(0, enough - 1);
  if (works.size() == 1) return product(works.front(), (enough + works.front() - 1) / works.front());
  std::vector<Ps> sums{0};  // ascending
  Ps least = unbounded_ps;
  for (std::size_t i = 0; i < sums.size() && sums[i] < enough; ++i) {
    if (sums.size() > most_sums) return enough - 1;
    for (const Ps work : works) {
      const Ps next = sums[i] + work;
      if (next >= enough) {
        least = std::min(least, next);
        break;
      }
      const auto at = std::lower_bound(sums.begin() + static_cast<std::ptrdiff_t>(i), sums.end(), next);
      if (at == sums.end() || *at != next) sums.insert(at, next);
    }
  }
  return least;
}

std::optional<PortAnalysis::Service> PortAnalysis::service_of(TrafficClass q, std::string& reason) {
  Service service;
  if (is_shaped(q)) {
    if (config_.shaping.is_timed(q)) {
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
  for (std::size_t f = 0; f < traffic_.flows.size(); ++f)
    if (const PortFlow& flow = traffic_.flows[f]; is_in_class(flow, q))
      bound_.flows[f].least_delay =
          model_.counts_packets ? octet_ * models::wire_length(flow.shortest.value_or(flow.frame)).count - gap_ : 0;
  std::string missed;
  const std::optional<SequenceBound> sequence = sequence_of(q, missed);
  std::vector<Ps> delays;
  const Ps by_room = wait_in_full_queue(q);
  // Frames that have their windows to themselves wait for nothing else: no other argument says more.
  if (is_shared(q))
    delays = delays_in_shares(q, bound.reason);
  else if (!sequence || !sequence->is_exact)
    delays = delays_in_busy_period(q, bound.reason, false);
  if (delays.empty() && !sequence) delays = delays_in_windows(q);
  if (delays.empty()) {
    if (!sequence && !is_bounded(by_room)) {
      if (!missed.empty()) bound.reason = missed;
      return;
    }
    bound.reason.clear();
    delays.assign(traffic_.flows.size(), unbounded_ps);
  }
  class_delay_[q] = 0;
  for (std::size_t f = 0, scheduled = 0; f < traffic_.flows.size(); ++f) {
    const PortFlow& flow = traffic_.flows[f];
    if (!is_in_class(flow, q)) continue;
    const Ps last_bit = octet_ * models::wire_length(flow.frame).count - gap_;
    PortFlowBound& made = bound_.flows[f];
    Ps delay = std::min(delays[f], sum(by_room, last_bit));
    if (sequence) {
      const SequencedTimes& times = sequence->flows[scheduled++];
      delay = std::min(delay, sum(stretched(times.wait), last_bit));
      made.leaves = ArrivalPhase{flow.phase->first + times.earliest + shrunk(last_bit), flow.phase->period,
                                 times.latest - times.earliest + stretched(last_bit) - shrunk(last_bit)};
    }
    made.delay =
        q != flow.highest_class ? std::max(made.delay, delay) : delay;  // or it was bounded in a higher class already
    class_delay_[q] = std::max(class_delay_[q], delay);
  }
  if (!is_bounded(class_delay_[q])) {
    bound.reason = "the link is too full to tell";
    return;
  }
  // What is in the queue, or on the wire, has come within the longest delay and the gap behind the frame.
  bound.backlog = demands_[q].work(sum(class_delay_[q], gap_));
  bound.backlog_frames = demands_[q].frames(sum(class_delay_[q], gap_));
  if (!is_bounded(bound.backlog))
    bound.reason = "a stream without a least gap between its frames, of which its queue drops what it has no room for";
  if (!sequence) return;
  bound.backlog = std::min(bound.backlog, sequence->backlog);
  bound.backlog_frames = std::min(bound.backlog_frames, sequence->backlog_frames);
}

/// What a frame waits for that the queue has room for: the frames in it, one that is on the medium, and what goes
/// before them. No busy period of the class is asked for, so this holds however much comes.
Ps PortAnalysis::wait_in_full_queue(TrafficClass q) {
  const models::QueueLimit& limit = config_.queue_limits[q];
  constexpr models::QueueLimit any;
  if ((limit.frames == any.frames && limit.octets == any.octets) || is_preemptable(q) || is_in_cqf(q) ||
      config_.shaping.is_timed(q) || is_shared(q) || !model_.counts_packets)
    return unbounded_ps;
  const ClassDemand& demand = demands_[q];
  const Ps around = octet_ * models::wire_length(sim::Octets{0}).count;  // preamble and gap
  const Ps by_octets = limit.octets / std::max<Ps>(1, (demand.shortest() - around) / octet_);
  const Ps frames = std::max<Ps>(1, std::min<Ps>(limit.frames, by_octets)) - 1;  // it has a place itself
  const Ps full =
      std::min(product(demand.longest(), frames), sum(product(octet_, limit.octets), product(around, frames)));
  std::string reason;
  const std::optional<Service> service = service_of(q, reason);
  if (!service) return unbounded_ps;
  if (service->is_shaped)
    return service->windows.empty()
               ? rounded_up((static_cast<double>(sum(full, demand.longest())) + service->credit) / service->idle_share)
               : unbounded_ps;
  // Where classes before it wait for nothing but each other, count from when they have begun to be busy, or from the
  // arrival: what they send has come since. Otherwise they may have a backlog.
  bool only_wait_for_others = service->windows.empty();
  for (TrafficClass h = 0; h < traffic_class_count; ++h)
    only_wait_for_others =
        only_wait_for_others && (h == q || !goes_before(h, q) || demands_[h].is_empty() || is_work_conserving(h));
  const Ps ahead = sum(full, std::max(service->blocked, demand.longest()));
  Ps time = 0;
  for (int step = 0; step < most_steps; ++step) {
    Ps need = ahead;
    for (TrafficClass h = 0; h < traffic_class_count; ++h)
      if (h != q && !demands_[h].is_empty() && goes_before(h, q) && overlap(q, h))
        need = sum(need, demands_[h].work(only_wait_for_others ? time : sum(time, class_delay_[h])));
    const Ps next = through_gates(*service, need);
    if (next > longest_search_ps) return unbounded_ps;
    if (next <= time) return time;
    time = next;
  }
  return unbounded_ps;
}

/// A class with all of the link, of its windows, or of its slope, may never be done. But if in each L, a multiple of
/// all periods, no more comes than is sent, a frame that comes L after another one waits for no longer: what has come
/// before it is more by as much as is sent in L. So nobody who comes later than L, and after links have ceased to limit
/// what comes, need be looked at.
std::optional<Ps> PortAnalysis::repeats_after(TrafficClass q, const Service& service) const {
  if (is_preemptable(q) || config_.shaping.is_timed(q) || is_shared(q)) return std::nullopt;
  std::optional<Ps> length = demands_[q].common_period(1, longest_search_ps);
  if (service.is_shaped) {  // what goes before it is in its credit
    if (!length || !service.windows.empty()) return std::nullopt;
    const sim::int128 slope =
        static_cast<sim::int128>(config_.shaping.shaper_of(q)->idle_slope.bits_per_second) * octet_;
    const Ps settled = demands_[q].settled_after();
    const bool keeps_up =
        static_cast<sim::int128>(demands_[q].work_in_each(*length)) * (8 * one_ppt) <= slope * *length;
    return keeps_up && is_bounded(sum(settled, *length)) ? std::optional(settled + *length) : std::nullopt;
  }
  std::vector<TrafficClass> classes{q};
  for (TrafficClass h = 0; h < traffic_class_count; ++h) {
    if (h == q || demands_[h].is_empty() || !goes_before(h, q) || !overlap(q, h)) continue;
    if (is_shaped(h)) return std::nullopt;
    classes.push_back(h);
    if (length) length = demands_[h].common_period(*length, longest_search_ps);
  }
  for (const PeriodicSupply& windows : service.windows)
    if (length) {
      if (windows.cycle() <= 0) return std::nullopt;
      const sim::int128 common =
          static_cast<sim::int128>(*length) / std::gcd(*length, windows.cycle()) * windows.cycle();
      length = common <= longest_search_ps ? std::optional(static_cast<Ps>(common)) : std::nullopt;
    }
  if (!length) return std::nullopt;
  Ps comes = 0;
  Ps settled = 0;
  for (const TrafficClass h : classes) {
    comes = sum(comes, demands_[h].work_in_each(*length));
    settled = std::max(settled, demands_[h].settled_after());
  }
  if (!is_bounded(sum(settled, *length))) return std::nullopt;
  if (service.windows.empty() && comes > *length) return std::nullopt;
  for (const PeriodicSupply& windows : service.windows)
    if (comes > product(windows.usable(), *length / windows.cycle())) return std::nullopt;
  return settled + *length;
}

/// By flow of the port; empty if there is none, with the reason.
std::vector<Ps> PortAnalysis::delays_in_busy_period(TrafficClass q, std::string& reason, bool by_turns) {
  std::optional<Service> service = service_of(q, reason);
  if (!service) return {};
  if (by_turns) share_by_turns(q, *service);
  // In the long run there must be room, or the search for a busy period goes on for ever.
  double room = service->is_shaped ? service->idle_share : 1;
  for (const PeriodicSupply& windows : service->windows)
    room = std::min(room, windows.share() * (service->is_shaped ? service->idle_share : 1));
  const double taken = taken_by(q, *service);
  const std::optional<Ps> repeats = repeats_after(q, *service);
  if (!repeats && !(taken <= room)) {
    reason = !(taken < 1e300) ? "a stream without a least gap between its frames"
             : room > 0       ? "more comes than the class can send"
                        : "no window of its gate leaves room for its longest frame and what may run into the window";
    return {};
  }
  // The longest busy period: until all that has come since its start is sent.
  Ps busy = 0;
  for (int step = 0; step < most_steps; ++step) {
    const Ps next = start(q, *service, demands_[q].work(busy), demands_[q].work(busy));
    if (!is_bounded(next)) {
      reason = "a class before it is unbounded, or the link is too full to tell";
      return {};
    }
    if (next <= busy) break;
    busy = next;
    if (repeats && busy > *repeats) break;
  }
  const bool is_endless = repeats && busy > *repeats;  // frames that come later wait for no longer
  if (is_endless)
    busy = *repeats;
  else
    busy_[q] = busy;
  const ClassDemand& demand = demands_[q];
  const Ps look_ahead = config_.shaping.is_timed(q) ? model_.late_by : 0;
  const std::vector<Ps> bends = demand.bends(sum(busy, look_ahead), most_bends);
  if (is_endless && bends.empty()) {
    reason = "the class is never done, and there is too much to look at";
    return {};
  }
  std::vector<Ps> works;  // of frames, each once
  for (const PortFlow& flow : traffic_.flows)
    if (flow.lowest_class <= q && q <= flow.highest_class)
      works.push_back(octet_ * models::wire_length(flow.frame).count);
  std::sort(works.begin(), works.end());
  works.erase(std::unique(works.begin(), works.end()), works.end());
  std::vector<Ps> longest(works.size(),
                          bends.empty() ? busy : 0);  // too many to look at: nobody waits for longer than a busy period
  // `at`: when the frame comes; `seen`: up to when others come before it, which is not earlier.
  const auto look = [&](Ps at, Ps seen) {
    for (std::size_t i = 0; i < works.size(); ++i) {
      const Ps last_bit = works[i] - gap_;
      const Ps all = demand.work(sum(seen, look_ahead));
      Ps done;
      if (is_preemptable(q) && service->is_shaped)
        done = sum(start(q, *service, std::max<Ps>(0, all - works[i]), all), transmission(q, works[i]));
      else if (is_preemptable(q))
        done = start(q, *service, std::max<Ps>(0, all - gap_), all);  // it may be cut until its last bit
      else
        done = sum(start(q, *service, std::max<Ps>(0, all - works[i]), all), model_.counts_packets ? last_bit : 0);
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
  const std::vector<Ps> waits = is_endless ? std::vector<Ps>() : waits_at_phases(q, *service, busy);
  std::vector<Ps> delays(traffic_.flows.size(), unbounded_ps);
  for (std::size_t f = 0, scheduled = 0; f < traffic_.flows.size(); ++f) {
    const PortFlow& flow = traffic_.flows[f];
    if (!is_in_class(flow, q)) continue;
    const auto work = static_cast<std::size_t>(
        std::lower_bound(works.begin(), works.end(), octet_ * models::wire_length(flow.frame).count) - works.begin());
    delays[f] = longest[work];
    if (!waits.empty() && flow.phase) delays[f] = std::min(delays[f], sum(waits[scheduled++], works[work] - gap_));
  }
  return delays;
}

PortBound bound_port(const PortModel& model, const PortTraffic& traffic) { return PortAnalysis(model, traffic).run(); }

}  // namespace takt::analysis
