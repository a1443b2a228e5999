// SPDX-License-Identifier: Apache-2.0
#include "schedule_check/check.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <utility>

namespace takt::schedule_check {
namespace {

using scenario::GateList;
using scenario::GateProblem;
using scenario::GateSolution;
using scenario::ScheduledHop;
using scenario::ScheduledStream;
using scenario::StreamWindow;
using sim::Duration;
using sim::int128;

constexpr std::int64_t ns = 1'000;

/// A frame of a stream at a port, in one cycle: what is certain of it. In ps since the cycle began; may begin before
/// it.
struct Passage {
  std::size_t stream = 0;
  std::size_t hop = 0;
  int128 earliest = 0;  ///< begin, by the fastest clock
  int128 latest = 0;    ///< end, by the slowest
};

class Checker {
 public:
  Checker(const GateProblem& problem, const GateSolution& schedule, std::size_t most)
      : problem_(problem), schedule_(schedule), most_(most) {}

  std::vector<std::string> run() {
    if (!has_all_parts()) return std::move(wrong_);
    for (std::size_t s = 0; s < problem_.streams.size(); ++s)
      for (std::size_t h = 0; h < problem_.streams[s].hops.size(); ++h) check_begin(s, h);
    for (std::size_t p = 0; p < problem_.ports.size(); ++p) check_port(p);
    return std::move(wrong_);
  }

 private:
  template <class... Args>
  void say(fmt::format_string<Args...> text, Args&&... args) {
    if (wrong_.size() < most_) wrong_.push_back(fmt::format(text, std::forward<Args>(args)...));
  }
  const ScheduledStream& stream(std::size_t s) const { return problem_.streams[s]; }
  const ScheduledHop& hop(std::size_t s, std::size_t h) const { return problem_.streams[s].hops[h]; }
  const StreamWindow& window(std::size_t s, std::size_t h) const { return schedule_.windows[s][h]; }
  std::string name(std::size_t s, std::size_t h) const {
    return fmt::format("\"{}\" at \"{}\"", stream(s).name, problem_.ports[hop(s, h).port].name);
  }

  bool has_all_parts() {
    if (schedule_.windows.size() != problem_.streams.size())
      say("windows of {} streams, not {}", schedule_.windows.size(), problem_.streams.size());
    if (schedule_.lists.size() != problem_.ports.size())
      say("lists of {} ports, not {}", schedule_.lists.size(), problem_.ports.size());
    for (std::size_t s = 0; s < problem_.streams.size() && wrong_.empty(); ++s)
      if (schedule_.windows[s].size() != stream(s).hops.size())
        say("\"{}\" has {} windows, not {}", stream(s).name, schedule_.windows[s].size(), stream(s).hops.size());
    return wrong_.empty();
  }

  /// A frame of `b` is always behind the one of `a` here: they left the talker in this order and came by the same
  /// ports.
  bool is_behind(std::size_t b, std::size_t hop_b, std::size_t a, std::size_t hop_a) const {
    if (a >= b || stream(a).train != stream(b).train) return false;
    for (;;) {
      if (hop(a, hop_a).port != hop(b, hop_b).port) return false;
      const auto before_a = hop(a, hop_a).previous;
      const auto before_b = hop(b, hop_b).previous;
      if (!before_a && !before_b) return true;
      if (!before_a || !before_b) return false;
      hop_a = *before_a;
      hop_b = *before_b;
    }
  }

  /// One of two copies of a frame that leave the talker by one port, behind the other; or one of two ways on which a
  /// frame may come from a merge, of which it takes one.
  bool is_copy(std::size_t later, std::size_t hop_later, std::size_t earlier, std::size_t hop_earlier) const {
    if (later != earlier || hop_later == hop_earlier) return false;
    if (hop(later, hop_later).is_merged && hop(earlier, hop_earlier).is_merged) return true;
    return hop_earlier < hop_later && !hop(later, hop_later).previous && !hop(earlier, hop_earlier).previous;
  }

  void check_begin(std::size_t s, std::size_t h) {
    const ScheduledHop& at = hop(s, h);
    const std::int64_t start = window(s, h).start.ps();
    const std::int64_t earliest = start - (at.previous ? problem_.margin.ps() : 0);
    const std::int64_t latest = start + at.transmission.ps() + problem_.margin.ps();
    const StreamWindow& said = window(s, h);
    if (said.open.ps() > earliest || said.open.ps() <= earliest - ns || said.close.ps() < latest ||
        said.close.ps() >= latest + ns)
      say("the window of {} is from {} ps to {} ps, not from {} ps to {} ps", name(s, h), said.open.ps(),
          said.close.ps(), earliest, latest);
    std::int64_t there = stream(s).release.ps();
    if (at.previous)
      there = window(s, *at.previous).start.ps() + hop(s, *at.previous).transmission.ps() +
              hop(s, *at.previous).behind.ps() - at.ahead.ps();
    if (start < there) return say("{} begins at {} ps, but cannot be there before {} ps", name(s, h), start, there);
    if (at.previous ? start == there : start < there + ns) return;
    // It waits: for the frame before it in its train, or the copy before it, which must end just then.
    for (std::size_t a = 0; a <= s; ++a)
      for (std::size_t g = 0; g < stream(a).hops.size(); ++g)
        if ((is_behind(s, h, a, g) || (!at.previous && is_copy(s, h, a, g) && hop(a, g).port == at.port)) &&
            window(a, g).start.ps() + hop(a, g).transmission.ps() + problem_.ports[at.port].gap.ps() == start)
          return;
    say("{} waits from {} ps to {} ps for nothing", name(s, h), there, start);
  }

  void check_port(std::size_t p) {
    const GateList& list = schedule_.lists[p];
    const std::string& port = problem_.ports[p].name;
    std::vector<std::pair<std::size_t, std::size_t>> here;
    for (std::size_t s = 0; s < problem_.streams.size(); ++s)
      for (std::size_t h = 0; h < stream(s).hops.size(); ++h)
        if (hop(s, h).port == p) here.emplace_back(s, h);
    if (here.empty()) return;
    int128 sum = 0;
    for (const GateList::Entry& entry : list.entries) {
      if (entry.interval.ps() < ns || entry.interval.ps() % ns != 0)
        return say("\"{}\" has an entry of {} ps", port, entry.interval.ps());
      sum += entry.interval.ps();
    }
    const scenario::ListLimits& limits = problem_.ports[p].limits;
    for (const GateList::Entry& entry : list.entries)
      if (entry.interval < limits.least_interval || entry.interval % limits.granularity != Duration())
        return say("\"{}\" has an entry of {} ps, which its device cannot", port, entry.interval.ps());
    if (list.cycle % limits.granularity != Duration())
      return say("the cycle of \"{}\" is {} ps, which its device cannot", port, list.cycle.ps());
    if (list.entries.empty() || list.entries.size() > std::min<std::size_t>(1024, limits.entries))
      return say("\"{}\" has {} entries", port, list.entries.size());
    if (sum != list.cycle.ps())
      return say("the entries of \"{}\" do not fill its cycle of {} ps", port, list.cycle.ps());
    for (const auto& [s, h] : here)
      if (stream(s).period.ps() <= 0 || list.cycle.ps() % stream(s).period.ps() != 0)
        return say("the cycle of \"{}\" is no multiple of the period of \"{}\"", port, stream(s).name);
    check_arrivals(here);
    const std::vector<Passage> passages = passages_of(p, here);
    check_meetings(p, passages);
    check_gates(p, passages);
  }

  /// At a talker frames of one class stand in one queue: of two trains none may come before another one in one turn and
  /// behind it in the next.
  void check_arrivals(const std::vector<std::pair<std::size_t, std::size_t>>& here) {
    for (const auto& [a, hop_a] : here)
      for (const auto& [b, hop_b] : here) {
        if (a >= b || stream(a).train == stream(b).train || hop(a, hop_a).previous || hop(b, hop_b).previous ||
            hop(a, hop_a).traffic_class != hop(b, hop_b).traffic_class)
          continue;
        const int128 first_a = (stream(a).release - stream(a).early).ps(), last_a = stream(a).release.ps();
        const int128 first_b = (stream(b).release - stream(b).early).ps(), last_b = stream(b).release.ps();
        if (first_a == last_a && first_b == last_b) continue;
        // Turns of a, until those of both have begun together again.
        const int128 turns = stream(b).period.ps();
        for (int128 n = 0; n < turns; ++n) {
          const int128 later = n * stream(a).period.ps();
          if (n > 0 && later % stream(b).period.ps() == 0) break;
          // The turns of b that begin last before the end of this one of a, whichever they are.
          int128 turn = (last_a + later - first_b) / stream(b).period.ps();
          while (first_b + turn * stream(b).period.ps() > last_a + later) --turn;
          if (last_b + turn * stream(b).period.ps() >= first_a + later) {
            say("{} and {} may come in any order", name(a, hop_a), name(b, hop_b));
            break;
          }
        }
      }
  }

  /// All frames of a cycle that begins long after the first ones.
  std::vector<Passage> passages_of(std::size_t p, const std::vector<std::pair<std::size_t, std::size_t>>& here) const {
    std::vector<Passage> passages;
    const int128 cycle = schedule_.lists[p].cycle.ps();
    for (const auto& [s, h] : here) {
      int128 begin = window(s, h).start.ps();
      while (begin >= cycle) begin -= begin / cycle * cycle;
      while (begin >= stream(s).period.ps()) begin -= stream(s).period.ps();
      const std::int64_t early = hop(s, h).previous ? problem_.margin.ps() : 0;
      for (; begin < cycle; begin += stream(s).period.ps())
        passages.push_back({s, h, begin - early, begin + hop(s, h).transmission.ps() + problem_.margin.ps()});
    }
    std::sort(passages.begin(), passages.end(), [](const Passage& a, const Passage& b) {
      return std::pair(a.earliest, a.stream) < std::pair(b.earliest, b.stream);
    });
    return passages;
  }

  void check_meetings(std::size_t p, const std::vector<Passage>& passages) {
    const int128 cycle = schedule_.lists[p].cycle.ps();
    const int128 gap = problem_.ports[p].gap.ps();
    // Round and round, until what begins is behind the end of what is asked.
    for (std::size_t i = 0; i < passages.size(); ++i) {
      const Passage& a = passages[i];
      for (std::size_t n = 1;; ++n) {
        const std::size_t j = (i + n) % passages.size();
        const int128 round = static_cast<int128>((i + n) / passages.size()) * cycle;
        const Passage& b = passages[j];
        if (b.earliest + round >= a.latest + gap) break;
        // In order since the talker, and of one turn of their train.
        const bool follows =
            (is_behind(b.stream, b.hop, a.stream, a.hop) || is_copy(b.stream, b.hop, a.stream, a.hop)) &&
            b.earliest + round - a.earliest == window(b.stream, b.hop).start.ps() - window(a.stream, a.hop).start.ps();
        if (!follows) {
          say("{} and {} meet at {} ps", name(a.stream, a.hop), name(b.stream, b.hop),
              static_cast<std::int64_t>((b.earliest + round) % cycle));
          break;
        }
      }
    }
  }

  void check_gates(std::size_t p, const std::vector<Passage>& passages) {
    const GateList& list = schedule_.lists[p];
    const std::string& port = problem_.ports[p].name;
    models::GateStates scheduled = 0;
    for (const Passage& each : passages)
      scheduled = static_cast<models::GateStates>(scheduled | 1u << hop(each.stream, each.hop).traffic_class);
    const auto others = static_cast<models::GateStates>(~scheduled);
    const int128 guard = problem_.ports[p].guard.ps();
    for (const Passage& each : passages) {
      const models::TrafficClass q = hop(each.stream, each.hop).traffic_class;
      for_entries(list, each.earliest, each.latest, [&](models::GateStates open) {
        if ((open >> q & 1) == 0)
          return say("class {} is closed where {} passes", q, name(each.stream, each.hop)), false;
        return true;
      });
      for_entries(list, each.earliest - guard, each.latest, [&](models::GateStates open) {
        if ((open & others) != 0)
          return say("another class is open where {} passes", name(each.stream, each.hop)), false;
        return true;
      });
    }
    // The other way: what each entry says has its reason. Where a list has limits, and of so many windows one has, time
    // of the other classes may be missing; and a class may be open for nobody while they are closed, if none of its
    // frames could use that to leave at another time.
    const bool takes_too_many =
        passages.size() * 3 >= problem_.ports[p].limits.entries;  // a guard, a window, time of the others
    const bool has_limits = problem_.ports[p].limits != scenario::ListLimits{} || takes_too_many;
    const bool may_be_wider = has_limits && !has_waiting(passages);
    int128 begin = 0;
    for (const GateList::Entry& entry : list.entries) {
      const int128 end = begin + entry.interval.ps();
      for (models::TrafficClass q = 0; q < models::traffic_class_count; ++q)
        if ((scheduled >> q & 1) != 0 && (entry.open >> q & 1) != 0 && !(may_be_wider && (entry.open & others) == 0) &&
            !is_covered(p, passages, begin, end, q))
          say("class {} of \"{}\" is open from {} ps on for nobody", q, port, static_cast<std::int64_t>(begin));
      if ((entry.open & others) != others && !has_limits && !is_covered(p, passages, begin, end, std::nullopt))
        say("other classes of \"{}\" are closed from {} ps on for nobody", port, static_cast<std::int64_t>(begin));
      begin = end;
    }
  }

  /// Whether a frame may stand in a queue before its window opens, or beside one of its train and another class, which
  /// would go first.
  bool has_waiting(const std::vector<Passage>& passages) const {
    for (const Passage& each : passages) {
      const ScheduledStream& one = stream(each.stream);
      if (!hop(each.stream, each.hop).previous && (one.early > Duration() || one.release.ps() % ns != 0)) return true;
      for (const Passage& other : passages)
        if (stream(other.stream).train == one.train &&
            hop(other.stream, other.hop).traffic_class != hop(each.stream, each.hop).traffic_class)
          return true;
    }
    return false;
  }

  /// Calls for each entry that some instant of [from, until) falls into, whatever the cycle; until it says no.
  template <class Ask>
  static void for_entries(const GateList& list, int128 from, int128 until, Ask ask) {
    const int128 cycle = list.cycle.ps();
    int128 turn = 0;
    while (turn > from) turn -= cycle;
    while (turn + cycle <= from) turn += cycle;
    for (; turn < until; turn += cycle) {
      int128 begin = turn;
      for (const GateList::Entry& entry : list.entries) {
        const int128 end = begin + entry.interval.ps();
        if (begin < until && end > from && !ask(entry.open)) return;
        begin = end;
      }
    }
  }

  /// All of [from, until) lies, to the ns, within passages of the class; without a class: of any, guards included.
  bool is_covered(std::size_t p, const std::vector<Passage>& passages, int128 from, int128 until,
                  std::optional<models::TrafficClass> q) const {
    const int128 cycle = schedule_.lists[p].cycle.ps();
    const int128 guard = q ? int128{0} : int128{problem_.ports[p].guard.ps()};
    for (bool moved = true; moved && from < until;) {
      moved = false;
      for (const Passage& each : passages) {
        if (q && hop(each.stream, each.hop).traffic_class != *q) continue;
        for (const int128 turn : {-cycle, int128{0}, cycle}) {
          const int128 begin = each.earliest - guard - ns + 1 + turn;
          const int128 end = each.latest + ns - 1 + turn;
          if (begin > from || end <= from) continue;
          from = end;
          moved = true;
        }
      }
    }
    return from >= until;
  }

  const GateProblem& problem_;
  const GateSolution& schedule_;
  std::size_t most_;
  std::vector<std::string> wrong_;
};

}  // namespace

std::vector<std::string> check(const GateProblem& problem, const GateSolution& schedule, std::size_t most) {
  return Checker(problem, schedule, most).run();
}

}  // namespace takt::schedule_check
