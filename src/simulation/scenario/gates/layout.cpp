// SPDX-License-Identifier: Apache-2.0
#include "scenario/gates/layout.hpp"

#include <algorithm>
#include <map>
#include <numeric>

#include "scenario/gates/crossings.hpp"
#include "scenario/gates/list_limits.hpp"

namespace takt::scenario {
namespace {

using sim::Duration;

class Layout {
 public:
  explicit Layout(const GateProblem& problem) : problem_(problem), crossings_(problem, Waiting::at_gates) {}

  GateLayout run() {
    layout_.schedule.windows = crossings_.windows();
    for (std::uint32_t p = 0; p < problem_.ports.size(); ++p) lay_port(p);
    return std::move(layout_);
  }

 private:
  const ScheduledStream& stream(Crossing c) const { return problem_.streams[c.stream]; }
  const ScheduledHop& hop(Crossing c) const { return crossings_.hop(c); }
  const StreamWindow& window(Crossing c) const { return crossings_.window(c); }
  Duration earliest(Crossing c) const { return crossings_.earliest(c); }
  Duration free_again(Crossing c) const { return crossings_.free_again(c); }

  void lay_port(std::uint32_t p) {
    layout_.schedule.lists.emplace_back();
    if (crossings_.at(p).empty()) return;
    if (!find_cycle(p)) return;
    const std::size_t before = layout_.conflicts.size();
    for (std::size_t i = 0; i < crossings_.at(p).size(); ++i)
      for (std::size_t j = 0; j <= i; ++j) compare(p, crossings_.at(p)[j], crossings_.at(p)[i]);
    if (layout_.conflicts.size() == before) make_list(p);
  }

  /// The least common multiple of the periods.
  bool find_cycle(std::uint32_t p) {
    Duration cycle = stream(crossings_.at(p).front()).period;
    const auto windows_in = [&](sim::int128 ps) {
      sim::int128 count = 0;
      for (const Crossing& c : crossings_.at(p)) count += ps / stream(c).period.ps();
      return count;
    };
    for (const Crossing& c : crossings_.at(p)) {
      const std::int64_t period = stream(c).period.ps();
      const sim::int128 common = static_cast<sim::int128>(cycle.ps()) / std::gcd(cycle.ps(), period) * period;
      if (common > longest_gate_cycle.ps() || windows_in(common) > most_windows_of_a_list) {
        const auto ps = static_cast<std::int64_t>(std::min<sim::int128>(common, INT64_MAX));
        layout_.conflicts.push_back({GateConflict::Kind::cycle_too_long,
                                     crossings_.at(p).front().stream,
                                     c.stream,
                                     p,
                                     {},
                                     {},
                                     {},
                                     {},
                                     Duration::from_ps(ps),
                                     static_cast<std::uint64_t>(std::min<sim::int128>(windows_in(common), INT64_MAX))});
        return false;
      }
      cycle = Duration::from_ps(static_cast<std::int64_t>(common));
    }
    layout_.schedule.lists[p].cycle = cycle;
    return true;
  }

  void compare(std::uint32_t p, Crossing a, Crossing b) {
    const std::int64_t common = std::gcd(stream(a).period.ps(), stream(b).period.ps());
    if (crossings_.come_in_any_order(a, b, common)) {
      layout_.conflicts.push_back(
          {GateConflict::Kind::order, a.stream, b.stream, p, stream(a).release - stream(a).early, stream(a).release,
           stream(b).release - stream(b).early, stream(b).release, layout_.schedule.lists[p].cycle, 0});
      return;
    }
    const std::int64_t length_a = (free_again(a) - earliest(a)).ps();
    const std::int64_t length_b = (free_again(b) - earliest(b)).ps();
    if (a.stream == b.stream && a.hop == b.hop) {
      if (length_a > common) overlap(p, a, b, common);
      return;
    }
    if (crossings_.is_same_frame(a, b)) std::swap(a, b);
    if (crossings_.follows(b, a) || crossings_.is_same_frame(b, a)) {
      // They may overlap by their margins; only the next of a must come after this one of b.
      if (free_again(b) > earliest(a) + stream(a).period)
        overlap(p, b, a, (earliest(a) + stream(a).period - earliest(b)).ps());
      return;
    }
    const std::int64_t distance = modulo((earliest(b) - earliest(a)).ps(), common);
    if (length_a > distance)
      overlap(p, a, b, distance);
    else if (distance + length_b > common)
      overlap(p, a, b, distance - common);
  }

  /// Somewhere in the cycle b begins `apart` after a.
  void overlap(std::uint32_t p, Crossing a, Crossing b, std::int64_t apart) {
    const Duration cycle = layout_.schedule.lists[p].cycle;
    std::int64_t at = modulo(earliest(a).ps(), stream(a).period.ps());
    while (modulo(at + apart - earliest(b).ps(), stream(b).period.ps()) != 0 && at < cycle.ps())
      at += stream(a).period.ps();
    // Told as windows, on whole ns.
    const Duration later_a = Duration::from_ps(at) - earliest(a);
    const Duration later_b = Duration::from_ps(at + apart) - earliest(b);
    layout_.conflicts.push_back({GateConflict::Kind::overlap, a.stream, b.stream, p, window(a).open + later_a,
                                 window(a).close + later_a, window(b).open + later_b, window(b).close + later_b, cycle,
                                 0});
  }

  /// What changes at an instant of the cycle: how many windows of each class are open, and how many keep the other
  /// classes closed.
  struct Change {
    std::array<int, models::traffic_class_count> open{};
    int busy = 0;
  };

  void make_list(std::uint32_t p) {
    GateList& list = layout_.schedule.lists[p];
    const std::int64_t cycle = list.cycle.ps();
    std::map<std::int64_t, Change> changes = {{0, {}}};
    Change now;
    models::GateStates scheduled = 0;
    // An interval of the circle; one that goes over its end is there at the beginning already.
    const auto mark = [&](Duration from, Duration until, auto&& member) {
      const std::int64_t begin = modulo(from.ps(), cycle);
      const std::int64_t end = modulo(until.ps(), cycle);
      if (end <= begin) ++member(now);
      ++member(changes[begin]);
      --member(changes[end]);
    };
    for (const Crossing& c : crossings_.at(p)) {
      const models::TrafficClass q = hop(c).traffic_class;
      scheduled = static_cast<models::GateStates>(scheduled | 1u << q);
      const std::int64_t instances = cycle / stream(c).period.ps();
      for (std::int64_t i = 0; i < instances; ++i) {
        const Duration later = stream(c).period * i;
        mark(window(c).open + later, window(c).close + later, [q](Change& change) -> int& { return change.open[q]; });
        const Duration guarded =
            std::max(floor_ns(earliest(c) - problem_.ports[p].guard), window(c).close - list.cycle);
        mark(guarded + later, window(c).close + later, [](Change& change) -> int& { return change.busy; });
      }
    }
    // What begins at 0 was counted as being there already if it went over the end; not if it begins there.
    for (auto at = changes.begin(); at != changes.end(); ++at) {
      for (std::size_t q = 0; q < now.open.size(); ++q) now.open[q] += at->second.open[q];
      now.busy += at->second.busy;
      models::GateStates states = now.busy > 0 ? models::GateStates{0} : static_cast<models::GateStates>(~scheduled);
      for (std::size_t q = 0; q < now.open.size(); ++q)
        if (now.open[q] > 0) states = static_cast<models::GateStates>(states | 1u << q);
      const auto next = std::next(at);
      const Duration interval = Duration::from_ps((next == changes.end() ? cycle : next->first) - at->first);
      if (!list.entries.empty() && list.entries.back().open == states)
        list.entries.back().interval += interval;
      else
        list.entries.push_back({states, interval});
    }
    FittedList fitted = fit_list(list, scheduled, has_waiting(p), problem_.ports[p].limits);
    if (fitted.obstacle == ListObstacle::none) {
      list = std::move(fitted.list);
      return;
    }
    if (problem_.ports[p].limits != ListLimits{}) {
      layout_.conflicts.push_back({GateConflict::Kind::limits,
                                   crossings_.at(p).front().stream,
                                   crossings_.at(p).back().stream,
                                   p,
                                   {},
                                   {},
                                   {},
                                   {},
                                   list.cycle,
                                   fitted.needed,
                                   fitted.obstacle});
      return;
    }
    const Crossing& shortest =
        *std::min_element(crossings_.at(p).begin(), crossings_.at(p).end(),
                          [&](Crossing a, Crossing b) { return stream(a).period < stream(b).period; });
    const Crossing& longest =
        *std::max_element(crossings_.at(p).begin(), crossings_.at(p).end(),
                          [&](Crossing a, Crossing b) { return stream(a).period < stream(b).period; });
    layout_.conflicts.push_back({GateConflict::Kind::cycle_too_long,
                                 shortest.stream,
                                 longest.stream,
                                 p,
                                 {},
                                 {},
                                 {},
                                 {},
                                 list.cycle,
                                 list.entries.size()});
  }

  /// Whether some frame waits there for its gate, or one of another class may stand beside it.
  bool has_waiting(std::uint32_t p) const {
    for (const Crossing& a : crossings_.at(p)) {
      if (!hop(a).previous && (stream(a).early > Duration() || stream(a).release != floor_ns(stream(a).release)))
        return true;
      for (const Crossing& b : crossings_.at(p))
        if (stream(a).train == stream(b).train && hop(a).traffic_class != hop(b).traffic_class) return true;
    }
    return false;
  }

  const GateProblem& problem_;
  const Crossings crossings_;
  GateLayout layout_;
};

}  // namespace

GateLayout lay_out_gates(const GateProblem& problem) { return Layout(problem).run(); }

}  // namespace takt::scenario
