// SPDX-License-Identifier: Apache-2.0
// The analysis of one port, class by class. For port_bound.cpp, port_cqf.cpp, port_schedule.cpp, port_shares.cpp and
// port_windows.cpp alone; everybody else calls bound_port().
#pragma once

#include <algorithm>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "analysis/class_demand.hpp"
#include "analysis/frame_sequence.hpp"
#include "analysis/gate_windows.hpp"
#include "analysis/port_bound.hpp"
#include "models/egress/class_set.hpp"
#include "models/egress/preemption.hpp"
#include "models/ethernet/sizes.hpp"

namespace takt::analysis {

/// Where the search for a fixed point gives up: delays beyond this are as good as unbounded.
inline constexpr Ps longest_search_ps = 100'000'000'000'000;  // 100 s
inline constexpr int most_steps = 100'000;

class PortAnalysis {
 public:
  PortAnalysis(const PortModel& model, const PortTraffic& traffic)
      : model_(model),
        traffic_(traffic),
        config_(*model.config),
        octet_(model.octet_time),
        gap_(octet_ * models::inter_packet_gap.count) {
    bound_.flows.resize(traffic.flows.size());
    for (models::TrafficClass q = 0; q < models::traffic_class_count; ++q)
      demands_.emplace_back(traffic, models::with(0, q), octet_,
                            model.cqf ? model.cqf->classes : models::ClassSet{0xFF});
    shaped_rate_.fill(std::numeric_limits<double>::infinity());
    shaped_burst_.fill(std::numeric_limits<double>::infinity());
    burst_behind_block_.fill(std::numeric_limits<double>::infinity());
    if (config_.shaping.gates) gates_.emplace_back(with_hold(*config_.shaping.gates));
    for (const models::GateConfig& gates : model.more_gates) gates_.emplace_back(with_hold(gates));
  }

  PortBound run() {
    // Express classes first: preemptable ones wait for all of them.
    for (const bool preemptable : {false, true})
      for (const bool shared : {false, true})  // those that share bandwidth wait for all others
        for (models::TrafficClass q = models::traffic_class_count; q-- > 0;) {
          if (!preemptable && !shared && model_.cqf && q == models::highest_class(model_.cqf->classes)) bound_cqf();
          if (is_preemptable(q) == preemptable && is_shared(q) == shared) bound_class(q);
        }
    for (models::TrafficClass q = models::traffic_class_count; q-- > 0;) refine_by_phases(q);
    return std::move(bound_);
  }

 private:
  bool is_preemptable(models::TrafficClass q) const {
    return config_.preemption && models::contains(config_.preemption->preemptable, q);
  }
  bool is_shaped(models::TrafficClass q) const { return config_.shaping.shaper_of(q) != nullptr; }
  /// It shares what the others leave (ETS).
  bool is_shared(models::TrafficClass q) const { return config_.shaping.is_shared(q); }
  bool shares(models::TrafficClass h, models::TrafficClass q) const {
    return is_shared(h) && is_shared(q) && is_preemptable(h) == is_preemptable(q);
  }
  bool is_in_cqf(models::TrafficClass q) const { return model_.cqf && models::contains(model_.cqf->classes, q); }
  bool is_gated(models::TrafficClass q) const {
    return std::any_of(gates_.begin(), gates_.end(), [&](const GateCycle& gates) { return !gates.is_always_open(q); });
  }
  bool is_in_class(const PortFlow& flow, models::TrafficClass q) const {
    return flow.lowest_class <= q && q <= flow.highest_class && !is_in_cqf(flow.highest_class);
  }
  /// A length of time by another clock, at most and at least.
  Ps stretched(Ps length) const { return scaled_up(length, one_ppt + model_.clock.rate_ppt, one_ppt); }
  Ps shrunk(Ps length) const { return scaled_down(length, one_ppt - model_.clock.rate_ppt, one_ppt); }
  /// A frame of the class waits for nothing but other frames.
  bool is_work_conserving(models::TrafficClass q) const { return !is_shaped(q) && !is_gated(q) && !is_in_cqf(q); }
  bool overlap(models::TrafficClass a, models::TrafficClass b) const {
    if (holds_late_ && is_preemptable(a) != is_preemptable(b)) return true;
    return gates_.empty() ||
           std::any_of(gates_.begin(), gates_.end(), [&](const GateCycle& gates) { return gates.overlap(a, b); });
  }
  /// Frames of h go before waiting ones of q; of classes that share bandwidth, those of each may.
  bool goes_before(models::TrafficClass h, models::TrafficClass q) const {
    if (is_preemptable(h) != is_preemptable(q)) return !is_preemptable(h);
    return is_shared(q) || (!is_shared(h) && h > q);
  }

  /// The longest frame of another class that may be under way when a frame of class q could start.
  Ps blocking(models::TrafficClass q) const {
    if (!model_.counts_packets) return 0;
    Ps longest = 0;
    for (models::TrafficClass other = 0; other < models::traffic_class_count; ++other) {
      if (other == q || demands_[other].is_empty() || goes_before(other, q)) continue;
      longest = std::max(longest, overlap(q, other) ? block_of(other, q) : gap_);
    }
    return longest;
  }
  /// For how long one frame of `other` keeps a frame of q from the medium.
  Ps block_of(models::TrafficClass other, models::TrafficClass q) const {
    const Ps frame = demands_[other].longest();
    if (!is_preemptable(other) || is_preemptable(q)) return frame;
    return std::min(frame, octet_ * models::longest_express_wait(config_.preemption->add_frag_size).count);
  }
  /// What of a window of q may be taken by a frame that began before it.
  Ps overhang(const GateCycle& gates, models::TrafficClass q) const {
    Ps longest = 0;
    for (models::TrafficClass other = 0; other < models::traffic_class_count; ++other) {
      if (demands_[other].is_empty()) continue;
      const bool counted_already = other == q || goes_before(other, q);
      longest = std::max(longest, counted_already ? gap_ : gates.overhang(q, other, block_of(other, q), gap_));
    }
    return longest;
  }

  /// What frames that begin before a window of q take of it, by window: of classes that are open then, and the gap
  /// behind those that have just closed, q itself among them; without those that are known to be elsewhere.
  std::vector<Ps> taken_at_starts(const GateCycle& gates, models::TrafficClass q, bool with_own = true,
                                  models::ClassSet elsewhere = 0) const {
    const std::vector<GateOpening>& windows = gates.windows(q);
    std::vector<Ps> taken(
        windows.size(),
        holds_ ? overhang(gates, q) : 0);  // before a hold the gates of preemptable classes only count as closed
    for (std::size_t w = 0; w < windows.size(); ++w)
      for (models::TrafficClass other = 0; other < models::traffic_class_count; ++other) {
        if (demands_[other].is_empty() || (other == q && !with_own) || models::contains(elsewhere, other)) continue;
        // Frames of a class that goes before are counted as they come, whenever they begin.
        const bool is_counted = other != q && goes_before(other, q) && overlap(q, other);
        taken[w] = std::max(taken[w], is_counted ? gap_ : gates.overhang_at(w, q, other, block_of(other, q), gap_));
      }
    return taken;
  }

  /// What classes that go before q send in an interval of that length in which q waits: closed at its end. Those with
  /// which it shares bandwidth do not count. Behind a block, which begins the interval, none of them has credit: what
  /// begins is a frame of another class.
  Ps interference(models::TrafficClass q, Ps length, bool is_behind_block = false) const {
    Ps all = 0;
    for (models::TrafficClass h = 0; h < models::traffic_class_count; ++h) {
      const ClassDemand& demand = demands_[h];
      if (h == q || demand.is_empty() || !goes_before(h, q) || !overlap(q, h) || (is_in_cqf(h) && is_in_cqf(q)) ||
          shares(h, q))
        continue;
      // Who has waited for a gate or for credit may have a backlog when the interval begins; but what is sent has come
      // within its delay.
      const Ps reach = is_work_conserving(h) ? length : sum(length, class_delay_[h]);
      Ps work = demand.work(reach);
      if (is_shaped(h))
        work = std::min(work, rounded_up((is_behind_block ? burst_behind_block_[h] : shaped_burst_[h]) +
                                         shaped_rate_[h] * static_cast<double>(length)));
      if (is_preemptable(q) && !is_preemptable(h))
        work = sum(work, product(octet_ * models::overhead_of_a_cut.count,
                                 std::min(demand.frames(reach), work / demand.shortest() + 1)));
      all = sum(all, work);
    }
    return all;
  }

  /// What cuts of frames of class q add in an interval of that length: each express frame makes one at most.
  Ps cuts(models::TrafficClass q, Ps length) const {
    if (!is_preemptable(q)) return 0;
    Ps all = 0;
    for (models::TrafficClass h = 0; h < models::traffic_class_count; ++h)
      if (!demands_[h].is_empty() && !is_preemptable(h))
        all = sum(all, product(octet_ * models::overhead_of_a_cut.count,
                               demands_[h].frames(is_work_conserving(h) ? length : sum(length, class_delay_[h]))));
    return all;
  }
  /// From the first to the last bit of a frame that occupies the medium for `work`, which express frames may cut.
  Ps transmission(models::TrafficClass q, Ps work) const {
    Ps time = 0;
    for (int step = 0; step < most_steps && time <= longest_search_ps; ++step) {
      Ps next = sum(work - gap_, cuts(q, time));
      for (models::TrafficClass h = 0; h < models::traffic_class_count; ++h)
        if (!demands_[h].is_empty() && !is_preemptable(h))
          next = sum(next, demands_[h].work(is_work_conserving(h) ? time : sum(time, class_delay_[h])));
      if (next <= time) return time;
      time = next;
    }
    return unbounded_ps;
  }

  struct Service {
    Ps blocked = 0;                       // by one frame, once
    std::vector<PeriodicSupply> windows;  // of each list; empty: always open
    bool is_shaped = false;
    double idle_share = 0;  // of the port's rate while the gate is open
    double credit = 0;      // the greatest, in time on the medium
    bool by_turns =
        false;  // what others send with whom it shares bandwidth is bounded by their turns, not by what comes
  };

  Ps through_gates(const Service& service, Ps need) const {
    Ps longest = service.windows.empty() ? need : 0;
    for (const PeriodicSupply& windows : service.windows) longest = std::max(longest, windows.time_for(need));
    return longest;
  }

  /// When work that comes after `before` has been sent can start, counted from the start of a busy period. Unbounded if
  /// that is not found. `own`: that with the frame that starts.
  Ps start(models::TrafficClass q, const Service& service, Ps before, Ps own) const {
    if (!is_bounded(before)) return unbounded_ps;
    Ps time = 0;
    for (int step = 0; step < most_steps; ++step) {
      Ps need =
          service.is_shaped
              ? rounded_up((static_cast<double>(sum(before, cuts(q, time))) + service.credit) / service.idle_share)
              : sum(service.blocked, before, interference(q, time));
      if (is_shared(q)) need = sum(need, sent_by_sharers(q, service, time, own));
      if (models::contains(model_.unordered, q))
        need = sum(need - std::min(before, need), std::max(before, demands_[q].work(time)));
      const Ps next = through_gates(service, need);
      if (next > longest_search_ps) return unbounded_ps;
      if (next <= time) return time;
      time = next;
    }
    return unbounded_ps;
  }

  /// Windows without the part in which the longest frame does not fit any more, and without what others may take of
  /// their starts.
  std::vector<PeriodicSupply> usable_windows(models::TrafficClass q) const {
    std::vector<PeriodicSupply> all;
    if (!is_gated(q)) return all;
    const Ps guard = model_.counts_packets ? demands_[q].longest() - gap_ : 0;
    for (const GateCycle& gates : gates_) {
      if (gates.is_always_open(q)) continue;
      const Ps hold = is_preemptable(q) ? hold_advance_ : 0;  // asked for so long before a window closes
      const bool is_whole = model_.counts_packets && !is_preemptable(q) && !holds_;
      all.emplace_back(gates, q, taken_at_starts(gates, q), model_.clock.error, guard + hold, model_.clock.slowest_ppt,
                       model_.clock.fastest_ppt, guard,
                       is_whole ? PackedWork([&](Ps room) { return packed(q, room); }) : PackedWork());
    }
    return all;
  }
  /// While the MAC holds, the gates of preemptable classes are as good as closed.
  models::GateConfig with_hold(models::GateConfig gates) {
    if (!config_.preemption) return gates;
    bool holds = false;
    for (int round = 0; round < 2; ++round)  // the first one finds what the second one begins with
      for (models::GateControlEntry& entry : gates.admin_control_list) {
        if (entry.operation != models::GateOperation::set_gate_states)
          holds = entry.operation == models::GateOperation::set_and_hold_mac;
        if (round == 1 && holds)
          entry.gate_states = static_cast<models::GateStates>(entry.gate_states & ~config_.preemption->preemptable);
        holds_ = holds_ || holds;
      }
    const Ps longest_wait = octet_ * models::longest_express_wait(config_.preemption->add_frag_size).count;
    hold_advance_ =
        holds_ ? std::max(longest_wait, config_.preemption->hold_advance.value_or(sim::Duration()).ps()) : 0;
    holds_late_ = holds_ && config_.preemption->hold_advance && config_.preemption->hold_advance->ps() < longest_wait;
    return gates;
  }

  Ps packed(models::TrafficClass q, Ps room) const;
  std::optional<Ps> repeats_after(models::TrafficClass q, const Service& service) const;
  Ps wait_in_full_queue(models::TrafficClass q);
  /// What goes before a class sends at most burst + rate * t, as a share of the port's rate.
  struct Line {
    double rate = 0;
    double burst = 0;
  };
  Line what_goes_before(models::TrafficClass q, bool is_behind_block) const;
  double longest_own_block(models::TrafficClass q, double idle_share, const Line& before) const;
  double credit_of_line(models::TrafficClass q, double idle_share, const Line& before) const;
  double greatest_credit(models::TrafficClass q, double idle_share, const Line& before) const;
  std::optional<Service> service_of(models::TrafficClass q, std::string& reason);
  bool make_shaped(models::TrafficClass q, Service& service, std::string& reason);
  void bound_class(models::TrafficClass q);
  std::vector<Ps> delays_in_busy_period(models::TrafficClass q, std::string& reason, bool by_turns);
  Ps quantum(models::TrafficClass q) const;
  Ps sent_by_sharers(models::TrafficClass q, const Service& service, Ps length, Ps own) const;
  void share_by_turns(models::TrafficClass q, Service& service) const;
  double taken_by(models::TrafficClass q, const Service& service) const;
  std::vector<Ps> delays_in_shares(models::TrafficClass q, std::string& reason);
  std::optional<SequenceBound> sequence_of(models::TrafficClass q, std::string& reason) const;
  bool may_be_sequenced(models::TrafficClass q) const;
  std::optional<std::vector<SequencedFlow>> sequenced_flows(models::TrafficClass q, std::string& reason) const;
  std::optional<SequenceBound> sequence_in_windows(models::TrafficClass q, const std::vector<SequencedFlow>& flows,
                                                   const OthersWork& others, models::ClassSet elsewhere,
                                                   std::string& reason) const;
  std::optional<SequenceBound> sequence_apart(models::TrafficClass q) const;
  SequenceWindows windows_of(const GateCycle& gates, models::TrafficClass q, models::ClassSet elsewhere) const;
  std::vector<Ps> delays_in_windows(models::TrafficClass q) const;
  std::vector<Ps> waits_at_phases(models::TrafficClass q, const Service& service, Ps busy) const;
  void refine_by_phases(models::TrafficClass q);
  bool phases_count(models::TrafficClass q) const;
  struct CycleOfCqf;
  void bound_cqf();
  Ps behind_its_header(const PortFlow& flow) const;
  CycleOfCqf count_cycle() const;
  std::int64_t frames_in_a_cycle(const PortFlow& flow, Ps length) const;
  std::optional<Ps> sent_in_a_cycle(models::TrafficClass q, Ps work) const;
  std::string objection_to_cqf() const;
  SendingCycle sending_cycle(const PortFlow& flow, std::int64_t frames, Ps greatest_sent) const;
  void set_unbounded(models::TrafficClass q, std::string reason) { bound_.classes[q].reason = std::move(reason); }

  const PortModel& model_;
  const PortTraffic& traffic_;
  const models::PortConfig& config_;
  Ps octet_;
  Ps gap_;
  bool holds_ = false;       // some entry of a list does
  bool holds_late_ = false;  // a preemptable frame may reach into what is held
  Ps hold_advance_ = 0;
  std::vector<ClassDemand> demands_;
  std::vector<GateCycle> gates_;
  PortBound bound_;
  std::array<Ps, models::traffic_class_count> class_delay_{};
  std::array<Ps, models::traffic_class_count> busy_{};  // the longest busy period, without phases; 0: not known
  std::array<double, models::traffic_class_count>
      shaped_rate_{};  // of each shaped class: what it sends in t is at most burst + rate * t
  std::array<double, models::traffic_class_count> shaped_burst_{};
  std::array<double, models::traffic_class_count>
      burst_behind_block_{};  // the same from the start of a frame of another class on
};

}  // namespace takt::analysis
