// SPDX-License-Identifier: Apache-2.0
#include "scenario/gates/offsets.hpp"

#include <algorithm>
#include <map>
#include <numeric>
#include <set>
#include <tuple>

#include "schedule/phases.hpp"

namespace takt::scenario {
namespace {

using sim::Duration;

constexpr std::int64_t ps_per_ns = 1'000;
constexpr int most_rounds = 64;
/// Questions whether an offset lies in an interval, about a nanosecond each: so many for all offsets of a round, shared
/// out among them, and no further round after as many.
constexpr std::size_t most_questions = 200'000'000;
/// One offset has a right to as many for each interval.
constexpr std::size_t least_questions = 20;

/// A movable stream must not be moved by x with `from` < x mod `modulus` < `from` + `length`: it would meet the other.
struct Forbidden {
  std::int64_t from = 0;    ///< ps, as the others below
  std::int64_t length = 0;  ///< more than the modulus: they meet whatever is chosen
  std::int64_t modulus = 1;
  Meeting meeting;

  bool always() const { return length > modulus; }
  /// How far x is within; 0: outside or at an end.
  std::int64_t depth(std::int64_t x) const {
    const std::int64_t behind = modulo(x - from, modulus);
    return behind == 0 || behind >= length ? 0 : behind;
  }
  /// The end of the interval in which x is.
  std::int64_t end(std::int64_t x) const { return x + length - depth(x); }
};

std::int64_t floor_to_ns(std::int64_t ps) { return (ps - modulo(ps, ps_per_ns)); }
std::int64_t ceil_to_ns(std::int64_t ps) { return (ps + ps_per_ns - 1) / ps_per_ns * ps_per_ns; }

class OffsetSearch {
 public:
  explicit OffsetSearch(const OffsetProblem& problem)
      : problem_(problem), crossings_(problem.gates, problem.waiting), unit_of_(problem.gates.streams.size(), nobody) {
    for (std::uint32_t u = 0; u < problem.movable.size(); ++u)
      for (const std::uint32_t s : problem.movable[u]) unit_of_[s] = u;
  }

  std::vector<ChosenOffset> run() {
    std::vector<std::uint32_t> order = by_need();
    std::set<std::uint32_t> tried_first;  // who finds nothing even then is left as it is
    std::vector<ChosenOffset> best;
    std::size_t least = 0;
    for (int round = 0; round < most_rounds; ++round) {
      const std::vector<std::uint32_t> failed = place(order);
      std::size_t meetings = 0;
      for (const ChosenOffset& each : chosen_) meetings += each.meetings.size();
      if (best.empty() || meetings < least) {
        best = chosen_;
        least = meetings;
      }
      if (least == 0 || questions_ > most_questions) break;
      const auto next = std::ranges::find_if(failed, [&](std::uint32_t unit) { return !tried_first.contains(unit); });
      if (next == failed.end()) break;
      tried_first.insert(*next);
      const auto at = std::ranges::find(order, *next);
      std::rotate(order.begin(), at, at + 1);
    }
    return least == 0 ? best : search(best, least);
  }

 private:
  static constexpr std::uint32_t nobody = 0xFFFF'FFFF;

  const ScheduledStream& stream(Crossing c) const { return problem_.gates.streams[c.stream]; }

  Duration period_of(std::uint32_t unit) const {
    Duration period = Duration::max();
    for (const std::uint32_t s : problem_.movable[unit]) period = std::min(period, problem_.gates.streams[s].period);
    return period;
  }

  std::vector<std::uint32_t> by_need() const {
    std::vector<std::uint32_t> order(problem_.movable.size());
    std::iota(order.begin(), order.end(), 0u);
    std::vector<std::pair<std::int64_t, std::int64_t>> need;
    for (std::uint32_t u = 0; u < problem_.movable.size(); ++u) {
      std::int64_t taken = 0;
      for (const std::uint32_t s : problem_.movable[u])
        for (std::uint32_t h = 0; h < problem_.gates.streams[s].hops.size(); ++h) taken += length({s, h});
      need.emplace_back(period_of(u).ps(), -taken);
    }
    std::ranges::stable_sort(order, {}, [&](std::uint32_t u) { return need[u]; });
    return order;
  }

  std::int64_t length(Crossing c) const { return (crossings_.free_again(c) - crossings_.earliest(c)).ps(); }

  /// Where the stream of another unit stays, if that is known yet.
  std::optional<std::int64_t> shift_of(std::uint32_t stream) const {
    const std::uint32_t unit = unit_of_[stream];
    if (unit == nobody) return 0;
    if (!placed_[unit]) return std::nullopt;
    return chosen_[unit].offset.ps();
  }

  std::vector<Forbidden> forbidden_of(std::uint32_t unit) const {
    std::vector<Forbidden> made;
    for (const std::uint32_t s : problem_.movable[unit])
      for (std::uint32_t h = 0; h < problem_.gates.streams[s].hops.size(); ++h) {
        const Crossing own{s, h};
        const std::uint32_t port = problem_.gates.streams[s].hops[h].port;
        for (const Crossing& other : crossings_.at(port)) {
          if (unit_of_[other.stream] == unit) continue;
          const std::optional<std::int64_t> shift = shift_of(other.stream);
          if (!shift) continue;
          const std::int64_t modulus = std::gcd(stream(own).period.ps(), stream(other).period.ps());
          const Meeting meeting{s, other.stream, port};
          // Two intervals on a circle meet unless one begins when or after the other has ended, both ways.
          const std::int64_t apart = (crossings_.earliest(other) - crossings_.earliest(own)).ps() + *shift;
          made.push_back({modulo(apart - length(own), modulus), length(own) + length(other), modulus, meeting});
          if (crossings_.share_a_queue(own, other)) {
            // Those that are early come in between: at the ends, too, they may stand in the other's window.
            const std::int64_t between =
                (stream(other).release - stream(other).early - stream(own).release + stream(own).early).ps() + *shift;
            made.push_back({modulo(between - stream(own).early.ps() - 1, modulus),
                            stream(own).early.ps() + stream(other).early.ps() + 2, modulus, meeting});
          }
        }
      }
    std::ranges::stable_sort(made, {},
                             &Forbidden::from);  // so that a walk along the time goes through them once or twice
    return made;
  }

  /// The units for which nothing was free.
  std::vector<std::uint32_t> place(const std::vector<std::uint32_t>& order) {
    chosen_.assign(problem_.movable.size(), {});
    placed_.assign(problem_.movable.size(), false);
    std::vector<std::uint32_t> failed;
    for (const std::uint32_t unit : order) {
      const std::vector<Forbidden> all = forbidden_of(unit);
      std::vector<Forbidden> avoidable;
      std::ranges::copy_if(all, std::back_inserter(avoidable), [](const Forbidden& each) { return !each.always(); });
      const std::int64_t period = repeats_after(avoidable, period_of(unit).ps());
      const std::size_t allowed =
          std::max(least_questions * avoidable.size(), most_questions / problem_.movable.size());
      const std::optional<std::int64_t> first = first_free(avoidable, period, allowed);
      chosen_[unit].offset = Duration::from_ps(first ? *first : least_bad(avoidable, period, allowed));
      chosen_[unit].meetings = meetings_at(all, chosen_[unit].offset.ps());
      placed_[unit] = true;
      if (!first) failed.push_back(unit);
    }
    return failed;
  }

  /// Where first fit finds nothing: whoever is in the way is moved, too. What does better counts.
  std::vector<ChosenOffset> search(std::vector<ChosenOffset> best, std::size_t least) {
    std::vector<schedule::Mover> movers;
    for (std::uint32_t u = 0; u < problem_.movable.size(); ++u) {
      schedule::Mover mover{"unit " + std::to_string(u), period_of(u).ps(), {}, {}};
      for (const std::uint32_t s : problem_.movable[u]) {
        if (problem_.gates.streams[s].period != period_of(u)) return best;  // its streams do not repeat as one
        claim(s, mover);
      }
      movers.push_back(std::move(mover));
    }
    for (std::uint32_t s = 0; s < problem_.gates.streams.size(); ++s) {
      if (unit_of_[s] != nobody) continue;
      schedule::Mover mover{"stream " + std::to_string(s), problem_.gates.streams[s].period.ps(), {}, 0};
      claim(s, mover);
      movers.push_back(std::move(mover));
    }
    constexpr std::uint32_t most_attempts = 16;
    const auto phases = schedule::find_phases(static_cast<std::uint32_t>(problem_.gates.ports.size() + queues_.size()),
                                              movers, most_attempts);
    if (!phases) return best;
    for (std::uint32_t u = 0; u < problem_.movable.size(); ++u) {
      chosen_[u].offset =
          Duration::from_ps(floor_to_ns((*phases)[u]));  // what the movers claim begins and ends on whole ns, so all of
                                                         // them may begin the rest of one earlier
      placed_[u] = true;
    }
    std::size_t meetings = 0;
    for (std::uint32_t u = 0; u < problem_.movable.size(); ++u) {
      chosen_[u].meetings = meetings_at(forbidden_of(u), chosen_[u].offset.ps());
      meetings += chosen_[u].meetings.size();
    }
    return meetings < least ? chosen_ : best;
  }

  /// What a stream occupies, in whole ns outwards: ports, and at its talker the queue in which those of one class must
  /// not come in any order.
  void claim(std::uint32_t s, schedule::Mover& mover) {
    const ScheduledStream& what = problem_.gates.streams[s];
    for (std::uint32_t h = 0; h < what.hops.size(); ++h) {
      const Crossing own{s, h};
      const std::int64_t from = floor_to_ns(crossings_.earliest(own).ps());
      mover.claims.push_back({what.hops[h].port, from, ceil_to_ns(crossings_.free_again(own).ps()) - from});
      if (what.hops[h].previous || problem_.waiting != Waiting::at_gates) continue;
      const auto queue = queues_
                             .try_emplace(std::pair(what.hops[h].port, what.hops[h].traffic_class),
                                          static_cast<std::uint32_t>(queues_.size()))
                             .first->second;
      const std::int64_t come = floor_to_ns((what.release - what.early).ps());
      mover.claims.push_back({static_cast<std::uint32_t>(problem_.gates.ports.size()) + queue, come,
                              ceil_to_ns(what.release.ps()) + ps_per_ns - come});
    }
  }

  /// Beyond the common multiple of all intervals everything comes again.
  static std::int64_t repeats_after(const std::vector<Forbidden>& forbidden, std::int64_t period) {
    sim::int128 common = 1;
    for (const Forbidden& each : forbidden) {
      common = common / std::gcd(static_cast<std::int64_t>(common), each.modulus) * each.modulus;
      if (common >= period) return period;
    }
    return std::min(period, ceil_to_ns(static_cast<std::int64_t>(common)));
  }

  /// From end to end of what is in the way, until a whole round says nothing.
  std::optional<std::int64_t> first_free(const std::vector<Forbidden>& forbidden, std::int64_t period,
                                         std::size_t allowed) {
    std::int64_t x = 0;
    std::size_t clear = 0;  // so many in a row are not in the way
    std::size_t asked = 0;
    for (std::size_t i = 0; clear < forbidden.size(); i = i + 1 < forbidden.size() ? i + 1 : 0) {
      if (++asked > allowed) break;
      if (forbidden[i].depth(x) == 0) {
        ++clear;
        continue;
      }
      x = ceil_to_ns(forbidden[i].end(x));
      if (x >= period) break;
      clear = 0;
    }
    questions_ += asked;
    return clear >= forbidden.size() ? std::optional(x) : std::nullopt;
  }

  /// Of the ends of what is in the way, as many as are allowed.
  std::int64_t least_bad(const std::vector<Forbidden>& forbidden, std::int64_t period, std::size_t allowed) {
    std::set<std::int64_t> candidates = {0};
    const std::size_t most = std::max<std::size_t>(least_questions, allowed / (forbidden.size() + 1));
    for (const Forbidden& each : forbidden)
      for (std::int64_t end = modulo(each.from + each.length, each.modulus); end < period && candidates.size() < most;
           end += each.modulus)
        if (ceil_to_ns(end) < period) candidates.insert(ceil_to_ns(end));
    questions_ += candidates.size() * forbidden.size();
    std::int64_t best = 0;
    std::size_t least = forbidden.size() + 1;
    for (const std::int64_t x : candidates) {
      const auto met = static_cast<std::size_t>(
          std::ranges::count_if(forbidden, [x](const Forbidden& each) { return each.depth(x) != 0; }));
      if (met >= least) continue;
      best = x;
      least = met;
    }
    return best;
  }

  static std::vector<Meeting> meetings_at(const std::vector<Forbidden>& forbidden, std::int64_t x) {
    std::vector<Meeting> made;
    std::set<std::tuple<std::uint32_t, std::uint32_t, std::uint32_t>> told;
    for (const Forbidden& each : forbidden)
      if ((each.always() || each.depth(x) != 0) &&
          told.emplace(each.meeting.stream, each.meeting.other, each.meeting.port).second)
        made.push_back(each.meeting);
    std::ranges::stable_sort(made, {},
                             [](const Meeting& each) { return std::tuple(each.stream, each.other, each.port); });
    return made;
  }

  const OffsetProblem& problem_;
  const Crossings crossings_;
  std::vector<std::uint32_t> unit_of_;  // by stream
  std::vector<ChosenOffset> chosen_;    // by unit
  std::vector<bool> placed_;
  std::size_t questions_ = 0;
  std::map<std::pair<std::uint32_t, models::TrafficClass>, std::uint32_t>
      queues_;  // at talkers: resources behind the ports
};

}  // namespace

std::vector<ChosenOffset> choose_offsets(const OffsetProblem& problem) { return OffsetSearch(problem).run(); }

}  // namespace takt::scenario
