#include "scenario/gates/layout.hpp"

#include <algorithm>
#include <map>
#include <numeric>

#include "sim/check.hpp"

namespace takt::scenario {
namespace {

using sim::Duration;

constexpr std::int64_t ps_per_ns = 1'000;

Duration floor_ns(Duration d) {
  const std::int64_t rest = d.ps() % ps_per_ns;
  return Duration::from_ps(d.ps() - rest - (rest < 0 ? ps_per_ns : 0));
}
Duration ceil_ns(Duration d) { return -floor_ns(-d); }
std::int64_t modulo(std::int64_t a, std::int64_t m) { return (a % m + m) % m; }

/// A stream at a hop.
struct Crossing {
  std::uint32_t stream = 0;
  std::uint32_t hop = 0;
};

class Layout {
 public:
  explicit Layout(const GateProblem& problem) : problem_(problem), crossings_(problem.ports.size()) {
    for (std::uint32_t s = 0; s < problem.streams.size(); ++s)
      for (std::uint32_t h = 0; h < problem.streams[s].hops.size(); ++h) crossings_[problem.streams[s].hops[h].port].push_back({s, h});
  }

  GateLayout run() {
    for (std::uint32_t s = 0; s < problem_.streams.size(); ++s) lay_stream(s);
    for (std::uint32_t p = 0; p < problem_.ports.size(); ++p) lay_port(p);
    return std::move(layout_);
  }

 private:
  const ScheduledStream& stream(Crossing c) const { return problem_.streams[c.stream]; }
  const ScheduledHop& hop(Crossing c) const { return problem_.streams[c.stream].hops[c.hop]; }
  const StreamWindow& window(Crossing c) const { return layout_.schedule.windows[c.stream][c.hop]; }
  /// Its frame may begin by then, as the clocks go. At the talker no margin: it is the talker's own clock.
  Duration earliest(Crossing c) const { return window(c).start - (hop(c).previous ? problem_.margin : Duration()); }
  /// The end of what keeps others away: the gap behind the latest frame is part of it.
  Duration free_again(Crossing c) const { return window(c).start + hop(c).transmission + problem_.margin + problem_.ports[hop(c).port].gap; }

  /// The later of two of one train came to the port behind the earlier, by the same port before: they stay in order, whatever the clocks say.
  bool follows(Crossing later, Crossing earlier) const {
    if (stream(later).train != stream(earlier).train || later.stream == earlier.stream) return false;
    const auto& a = hop(earlier).previous;
    const auto& b = hop(later).previous;
    if (!a || !b) return !a && !b && earlier.stream < later.stream;
    const Crossing earlier_before{earlier.stream, *a};
    const Crossing later_before{later.stream, *b};
    return hop(earlier_before).port == hop(later_before).port && follows(later_before, earlier_before);
  }

  void lay_stream(std::uint32_t s) {
    const ScheduledStream& each = problem_.streams[s];
    layout_.schedule.windows.emplace_back();
    for (std::uint32_t h = 0; h < each.hops.size(); ++h) {
      const ScheduledHop& at = each.hops[h];
      Duration start = ceil_ns(each.release);
      if (at.previous) {
        TAKT_CHECK(*at.previous < h, "hops stand in the order of the way");
        start = layout_.schedule.windows[s][*at.previous].start + each.hops[*at.previous].transmission + each.hops[*at.previous].behind;
      }
      for (const Crossing& other : crossings_[at.port])
        if (other.stream < s && follows({s, h}, other)) start = std::max(start, window(other).start + hop(other).transmission + problem_.ports[at.port].gap);
      const Duration early = at.previous ? problem_.margin : Duration();
      layout_.schedule.windows[s].push_back({start, floor_ns(start - early), ceil_ns(start + at.transmission + problem_.margin)});
    }
  }

  void lay_port(std::uint32_t p) {
    layout_.schedule.lists.emplace_back();
    if (crossings_[p].empty()) return;
    if (!find_cycle(p)) return;
    const std::size_t before = layout_.conflicts.size();
    for (std::size_t i = 0; i < crossings_[p].size(); ++i)
      for (std::size_t j = 0; j <= i; ++j) compare(p, crossings_[p][j], crossings_[p][i]);
    if (layout_.conflicts.size() == before) make_list(p);
  }

  /// The least common multiple of the periods.
  bool find_cycle(std::uint32_t p) {
    Duration cycle = stream(crossings_[p].front()).period;
    const auto windows_in = [&](sim::int128 ps) {
      sim::int128 count = 0;
      for (const Crossing& c : crossings_[p]) count += ps / stream(c).period.ps();
      return count;
    };
    for (const Crossing& c : crossings_[p]) {
      const std::int64_t period = stream(c).period.ps();
      const sim::int128 common = static_cast<sim::int128>(cycle.ps()) / std::gcd(cycle.ps(), period) * period;
      // Each window takes an entry at least.
      if (common > longest_gate_cycle.ps() || windows_in(common) > static_cast<sim::int128>(most_gate_entries)) {
        const auto ps = static_cast<std::int64_t>(std::min<sim::int128>(common, INT64_MAX));
        layout_.conflicts.push_back({GateConflict::Kind::cycle_too_long, crossings_[p].front().stream, c.stream, p, {}, {}, {}, {}, Duration::from_ps(ps),
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
    if (comes_in_any_order(a, b, common)) {
      layout_.conflicts.push_back({GateConflict::Kind::order, a.stream, b.stream, p, stream(a).release - stream(a).early, stream(a).release, stream(b).release - stream(b).early, stream(b).release,
                                   layout_.schedule.lists[p].cycle, 0});
      return;
    }
    const std::int64_t length_a = (free_again(a) - earliest(a)).ps();
    const std::int64_t length_b = (free_again(b) - earliest(b)).ps();
    if (a.stream == b.stream) {
      if (length_a > common) overlap(p, a, b, common);
      return;
    }
    if (follows(b, a)) {
      // They may overlap by their margins; only the next of a must come after this one of b.
      if (free_again(b) > earliest(a) + stream(a).period) overlap(p, b, a, (earliest(a) + stream(a).period - earliest(b)).ps());
      return;
    }
    const std::int64_t distance = modulo((earliest(b) - earliest(a)).ps(), common);
    if (length_a > distance) overlap(p, a, b, distance);
    else if (distance + length_b > common) overlap(p, a, b, distance - common);
  }

  /// At their talker, in one queue: the first to come would stand in the window of the other.
  bool comes_in_any_order(Crossing a, Crossing b, std::int64_t common) const {
    if (hop(a).previous || hop(b).previous || hop(a).traffic_class != hop(b).traffic_class || stream(a).train == stream(b).train) return false;
    if (stream(a).early == Duration() && stream(b).early == Duration()) return false;  // at two instants; at one their windows overlap
    const std::int64_t distance = modulo((stream(b).release - stream(b).early - stream(a).release + stream(a).early).ps(), common);
    return stream(a).early.ps() >= distance || distance + stream(b).early.ps() >= common;
  }

  /// Somewhere in the cycle b begins `apart` after a.
  void overlap(std::uint32_t p, Crossing a, Crossing b, std::int64_t apart) {
    const Duration cycle = layout_.schedule.lists[p].cycle;
    std::int64_t at = modulo(earliest(a).ps(), stream(a).period.ps());
    while (modulo(at + apart - earliest(b).ps(), stream(b).period.ps()) != 0 && at < cycle.ps()) at += stream(a).period.ps();
    // Told as windows, on whole ns.
    const Duration later_a = Duration::from_ps(at) - earliest(a);
    const Duration later_b = Duration::from_ps(at + apart) - earliest(b);
    layout_.conflicts.push_back({GateConflict::Kind::overlap, a.stream, b.stream, p, window(a).open + later_a, window(a).close + later_a, window(b).open + later_b,
                                 window(b).close + later_b, cycle, 0});
  }

  /// What changes at an instant of the cycle: how many windows of each class are open, and how many keep the other classes closed.
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
    for (const Crossing& c : crossings_[p]) {
      const models::TrafficClass q = hop(c).traffic_class;
      scheduled = static_cast<models::GateStates>(scheduled | 1u << q);
      const std::int64_t instances = cycle / stream(c).period.ps();
      for (std::int64_t i = 0; i < instances; ++i) {
        const Duration later = stream(c).period * i;
        mark(window(c).open + later, window(c).close + later, [q](Change& change) -> int& { return change.open[q]; });
        const Duration guarded = std::max(floor_ns(earliest(c) - problem_.ports[p].guard), window(c).close - list.cycle);
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
      if (!list.entries.empty() && list.entries.back().open == states) list.entries.back().interval += interval;
      else list.entries.push_back({states, interval});
    }
    if (list.entries.size() <= most_gate_entries) return;
    const Crossing& shortest = *std::min_element(crossings_[p].begin(), crossings_[p].end(), [&](Crossing a, Crossing b) { return stream(a).period < stream(b).period; });
    const Crossing& longest = *std::max_element(crossings_[p].begin(), crossings_[p].end(), [&](Crossing a, Crossing b) { return stream(a).period < stream(b).period; });
    layout_.conflicts.push_back({GateConflict::Kind::cycle_too_long, shortest.stream, longest.stream, p, {}, {}, {}, {}, list.cycle, list.entries.size()});
  }

  const GateProblem& problem_;
  std::vector<std::vector<Crossing>> crossings_;  // by port
  GateLayout layout_;
};

}  // namespace

GateLayout lay_out_gates(const GateProblem& problem) { return Layout(problem).run(); }

}  // namespace takt::scenario
