// SPDX-License-Identifier: Apache-2.0
#include "analysis/phased_bound.hpp"

#include <algorithm>
#include <numeric>
#include <tuple>

namespace takt::analysis {
namespace {

using Flow = PhasedTraffic::Flow;
using Role = PhasedTraffic::Role;

constexpr std::int64_t most_turns = 2'000;  // of a flow, until all phases repeat
constexpr std::size_t most_jumps = 50;
constexpr std::int64_t most_looks = 1'000'000;  // at a flow
constexpr int most_phase_steps = 1'000;

Ps floor_of(Ps a, Ps b) { return a >= 0 ? a / b : -((-a + b - 1) / b); }
Ps ceiling_of(Ps a, Ps b) { return -floor_of(-a, b); }

/// Instants [first, last] at which a busy period may begin, of which the last one is the worst.
struct Begin {
  Ps first = 0;
  Ps last = 0;
};

class PhasedWaits {
 public:
  explicit PhasedWaits(const PhasedTraffic& traffic)
      : t_(traffic), flows_(traffic.flows), links_(traffic.links.size()) {}

  std::optional<std::vector<Ps>> run() {
    if (!is_bounded(t_.busy) || !prepare()) return std::nullopt;
    std::vector<Ps> waits(flows_.size(), unbounded_ps);
    for (std::size_t f = 0; f < flows_.size(); ++f) {
      const Flow& flow = flows_[f];
      if (flow.role != Role::own || !flow.phase) continue;
      Ps longest = 0;
      for (Ps turn = 0; turn < hyperperiod_ / flow.phase->period; ++turn) {
        const Ps first = flow.phase->first + turn * flow.phase->period;
        const std::optional<Ps> wait = wait_of(flow, first, first + flow.phase->width);
        if (!wait) return std::nullopt;
        longest = std::max(longest, *wait);
      }
      waits[f] = scaled_up(longest, one_ppt + t_.rate_ppt, one_ppt);
    }
    return waits;
  }

 private:
  Ps slow(Ps length) const { return scaled_up(length, one_ppt + t_.rate_ppt, one_ppt); }

  /// What of the phases is worth keeping: those of a hyperperiod that ends soon. False if nothing is to be said.
  bool prepare() {
    busy_ = slow(t_.busy);
    forget_phases();
    for (const Flow& flow : flows_) {
      if (flow.role == Role::behind) continue;
      links_[flow.link].at_once = std::max(links_[flow.link].at_once, flow.work);
      if (flow.phase) continue;
      if (!flow.arrivals->is_limited()) return false;
      are_all_known_ = false;
      for (Ps jump = flow.arrivals->next_jump(0); jump <= busy_; jump = flow.arrivals->next_jump(jump)) {
        jumps_.push_back(jump);
        if (jumps_.size() > most_jumps) return false;
      }
    }
    if (!are_all_known_) jumps_.push_back(0);
    std::sort(jumps_.begin(), jumps_.end());
    jumps_.erase(std::unique(jumps_.begin(), jumps_.end()), jumps_.end());
    return true;
  }
  /// Which phases are kept does not depend on the order of the flows: of each role those of the shortest periods first,
  /// and those of one period all or none.
  void forget_phases() {
    std::vector<Flow*> flows;
    for (Flow& flow : flows_)
      if (flow.phase) flows.push_back(&flow);
    std::sort(flows.begin(), flows.end(), [](const Flow* a, const Flow* b) {
      return std::tuple(a->role, a->phase->period) < std::tuple(b->role, b->phase->period);
    });
    for (Flow* const flow : flows)
      if (!keeps(*flow->phase)) flow->phase.reset();
  }
  bool keeps(const ArrivalPhase& phase) {
    if (phase.width >= phase.period) return false;
    const Ps shortest = shortest_ == 0 ? phase.period : std::min(shortest_, phase.period);
    const sim::int128 next =
        static_cast<sim::int128>(hyperperiod_ / std::gcd(hyperperiod_, phase.period)) * phase.period;
    if (next > static_cast<sim::int128>(shortest) * most_turns) return false;
    hyperperiod_ = static_cast<Ps>(next);
    shortest_ = shortest;
    return true;
  }

  /// Frames that may come at or after `from` and at or before `until`.
  static std::int64_t count(const ArrivalPhase& phase, Ps from, Ps until) {
    return std::max<std::int64_t>(0, floor_of(until - phase.first, phase.period) -
                                         ceiling_of(from - phase.first - phase.width, phase.period) + 1);
  }

  /// Work of one role: of phased frames that may come between two instants, of others what comes in an interval of
  /// `length`, and of no link more than it carries in `longest`.
  Ps work(Role role, Ps from, Ps until, Ps length, Ps longest) {
    for (Link& link : links_) link.work = 0;
    for (const Flow& flow : flows_) {
      if (flow.role != role) continue;
      ++looks_;
      Ps& of_link = links_[flow.link].work;
      of_link =
          sum(of_link, product(flow.work, flow.phase ? count(*flow.phase, from, until) : flow.arrivals->count(length)));
    }
    Ps all = 0;
    for (std::size_t l = 0; l < links_.size(); ++l) {
      const std::optional<Ps>& octet_time = t_.links[l].octet_time;
      all = sum(all, octet_time ? std::min(links_[l].work,
                                           sum(links_[l].at_once, scaled_up(longest, t_.octet_time, *octet_time)))
                                : links_[l].work);
    }
    return all;
  }

  /// For how long after `from` frames of lower classes may be on the medium that have begun before some instant of
  /// [from, until].
  Ps blocking(Ps from, Ps until) {
    Ps longest = 0;
    for (const Flow& flow : flows_) {
      if (flow.role != Role::behind || flow.work <= longest) continue;
      ++looks_;
      Ps blocked = flow.work;
      if (flow.phase && is_bounded(flow.stays)) {
        const Ps last =
            flow.phase->first + floor_of(until - flow.phase->first, flow.phase->period) * flow.phase->period;
        blocked = std::min(blocked, sum(last + flow.phase->width - from, slow(flow.stays)));
      }
      longest = std::max(longest, blocked);
    }
    return longest;
  }

  /// The instants up to x at which a busy period may begin, in stretches in which the same frames count.
  std::vector<Begin> begins_before(Ps x) {
    std::vector<Ps> lasts{x};
    for (const Ps jump : jumps_) lasts.push_back(x - jump);
    for (const Flow& flow : flows_) {
      if (flow.role == Role::behind || !flow.phase) continue;
      ++looks_;
      const Ps latest = flow.phase->first + flow.phase->width;
      for (Ps at = latest + ceiling_of(x - busy_ - latest, flow.phase->period) * flow.phase->period; at <= x;
           at += flow.phase->period) {
        lasts.push_back(at);
        if (lasts.size() > most_turns) return {};
      }
    }
    std::sort(lasts.begin(), lasts.end());
    lasts.erase(std::unique(lasts.begin(), lasts.end()), lasts.end());
    std::vector<Begin> begins;
    Ps before = x - busy_ - 1;
    for (const Ps last : lasts) {
      if (last < x - busy_) continue;
      begins.push_back({before + 1, last});
      before = last;
    }
    if (are_all_known_)
      for (Begin& begin : begins) {
        // With all phases known nobody comes in the gaps between them.
        Ps earliest = begin.last;
        for (const Flow& flow : flows_) {
          if (flow.role == Role::behind) continue;
          ++looks_;
          const Ps first =
              flow.phase->first + floor_of(begin.last - flow.phase->first, flow.phase->period) * flow.phase->period;
          if (first + flow.phase->width >= begin.first) earliest = std::min(earliest, first);
        }
        begin.first = std::max(begin.first, earliest);
      }
    return begins;
  }

  /// When a frame may come so that what counts is something else.
  std::vector<Ps> arrivals_between(Ps earliest, Ps latest) {
    std::vector<Ps> instants{earliest};
    for (const Flow& flow : flows_) {
      if (flow.role == Role::behind || !flow.phase || instants.size() > most_turns) continue;
      ++looks_;
      const auto add = [&](Ps at) {
        for (at += ceiling_of(earliest + 1 - at, flow.phase->period) * flow.phase->period; at <= latest;
             at += flow.phase->period)
          if (instants.size() <= most_turns) instants.push_back(at);
      };
      if (flow.role == Role::own) add(flow.phase->first);
      add(flow.phase->first + flow.phase->width);
      for (const Ps jump : jumps_) add(flow.phase->first + flow.phase->width + jump);
    }
    std::sort(instants.begin(), instants.end());
    instants.erase(std::unique(instants.begin(), instants.end()), instants.end());
    return instants;
  }

  /// Of the frame of a flow that comes between two instants. Nothing if there is too much to look at.
  std::optional<Ps> wait_of(const Flow& flow, Ps earliest, Ps latest) {
    const std::vector<Ps> instants = arrivals_between(earliest, latest);
    if (instants.size() > most_turns) return std::nullopt;
    Ps longest = 0;
    for (std::size_t i = 0; i < instants.size(); ++i) {
      const Ps x = instants[i];
      const Ps until = i + 1 < instants.size() ? instants[i + 1] - 1 : latest;  // up to there the same frames count
      const std::vector<Begin> begins = begins_before(x);
      if (begins.empty() || looks_ > most_looks) return std::nullopt;
      for (const Begin& begin : begins) {
        // It is among those that count.
        const Ps own = std::max<Ps>(
            0, work(Role::own, begin.last, x, slow(x - begin.first), slow(until - begin.first)) - flow.work);
        const Ps blocked = blocking(begin.first, begin.last + (until - x));
        Ps started = begin.last;
        for (int step = 0;; ++step) {
          if (step == most_phase_steps || looks_ > most_looks) return std::nullopt;
          const Ps length = slow(started - begin.last);
          const Ps next =
              sum(begin.last,
                  slow(sum(blocked, own, work(Role::before, begin.last, started + (until - x), length, length))));
          if (!is_bounded(next)) return std::nullopt;
          if (next <= started) break;
          started = next;
        }
        longest = std::max(longest, started - x);
      }
    }
    return longest;
  }

  const PhasedTraffic& t_;
  std::vector<Flow> flows_;  // phases that do not help are forgotten
  struct Link {
    Ps at_once = 0;  // the longest frame
    Ps work = 0;     // in what is counted just now
  };
  std::vector<Link> links_;
  std::vector<Ps> jumps_;  // of what comes at no known phase
  bool are_all_known_ = true;
  Ps busy_ = 0;
  Ps hyperperiod_ = 1;
  Ps shortest_ = 0;  // period
  std::int64_t looks_ = 0;
};

}  // namespace

std::optional<std::vector<Ps>> waits_by_phases(const PhasedTraffic& traffic) { return PhasedWaits(traffic).run(); }

}  // namespace takt::analysis
