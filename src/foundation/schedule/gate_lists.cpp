// SPDX-License-Identifier: Apache-2.0
#include "schedule/gate_lists.hpp"

#include <algorithm>
#include <numeric>
#include <vector>

#include "schedule/timing.hpp"

namespace takt::schedule {
namespace {

constexpr std::size_t most_passes = 200'000;

/// A repetition on a link.
struct Pass {
  Ps from = 0, until = 0;
  std::uint8_t traffic_class = 0;
  bool waits = false;
  bool from_talker = false;
};

/// A stretch of time in which the unscheduled classes are closed.
struct Stretch {
  Ps begin = 0, end = 0;
  std::uint8_t open = 0;
};

std::string name_of(std::uint64_t count, const char* what) { return std::to_string(count) + " " + what; }

class ListMaker {
 public:
  ListMaker(const Problem& problem, const Solution& solution)
      : problem_(problem),
        timing_(problem, solution.timing),
        passes_(problem.links.size()),
        spans_(problem.links.size(), 1) {
    const auto common = hyperperiod(problem);
    for (StreamIndex s = 0; s < solution.streams.size(); ++s) {
      if (!solution.streams[s]) continue;
      const Placement& placement = *solution.streams[s];
      for (std::size_t hop = 0; hop < placement.route.size(); ++hop) {
        Ps& span = spans_[placement.route[hop]];
        if (span == 0) continue;
        const Ps period = placement.starts[hop].size() > 1 && common ? *common : problem.streams[s].period;
        const Ps factor = period / std::gcd(span, period);
        span = factor > longest_time / span ? 0 : span * factor;
      }
    }
    for (StreamIndex s = 0; s < solution.streams.size(); ++s)
      if (solution.streams[s]) note(s, *solution.streams[s]);
  }

  std::optional<std::string> list(LinkIndex l, const ListLimits& limits, GateList& list) {
    const Link& link = problem_.links[l];
    if (spans_[l] == 0 || passes_[l].size() >= most_passes)
      return link.name +
             " has no list: everything repeats after too long a time; periods with a shorter common multiple would do";
    const Ps tick = problem_.model.tick;
    if (spans_[l] % tick != 0)
      return link.name + " has no list: its cycle of " +
             name_of(static_cast<std::uint64_t>(spans_[l]), "ps is no multiple of the granularity of gates");
    for (const Pass& pass : passes_[l])
      if (pass.waits && pass.from % tick != 0)
        return link.name + " has no list: a frame that waits starts between two ticks";
    std::vector<Stretch> stretches = stretches_of(l);
    const std::size_t most = std::min(limits.entries, link.entries);
    while (entries_of(stretches, spans_[l]).size() > most)
      if (!join_nearest(stretches, spans_[l])) {
        return link.name + " needs " + name_of(entries_of(stretches, spans_[l]).size(), "entries, and takes ") +
               std::to_string(most) + "; fewer classes on it, or frames that do not wait, would do";
      }
    list.cycle = spans_[l];
    list.entries = entries_of(stretches, spans_[l]);
    return std::nullopt;
  }
  bool is_used(LinkIndex l) const { return !passes_[l].empty() || spans_[l] == 0; }

 private:
  void note(StreamIndex s, const Placement& placement) {
    const Stream& stream = problem_.streams[s];
    for (std::size_t hop = 0; hop < placement.route.size(); ++hop) {
      const LinkIndex l = placement.route[hop];
      const Link& link = problem_.links[l];
      std::int64_t parent = -1;
      for (std::size_t j = 0; j < hop; ++j)
        if (problem_.links[placement.route[j]].to == link.from) parent = static_cast<std::int64_t>(j);
      const auto& starts = placement.starts[hop];
      const Ps span = spans_[l];
      if (span == 0) continue;
      for (Ps k = 0; k < span / stream.period && passes_[l].size() < most_passes; ++k) {
        const Ps start = starts.size() > 1 ? starts[static_cast<std::size_t>(k)] : starts[0] + k * stream.period;
        Pass pass;
        pass.from = (start % span + span) % span;
        pass.until = pass.from + timing_.block(stream, link);
        pass.traffic_class = placement.classes[hop];
        pass.from_talker = parent < 0;
        if (parent >= 0) {
          const Link& before = problem_.links[placement.route[static_cast<std::size_t>(parent)]];
          const auto& earlier = placement.starts[static_cast<std::size_t>(parent)];
          const Ps there =
              (earlier.size() > 1 ? earlier[static_cast<std::size_t>(k)] : earlier[0] + k * stream.period) +
              timing_.onward(stream, before, link) - timing_.train_delay(stream, before, link);
          pass.waits = start > there;
        }
        passes_[l].push_back(pass);
      }
    }
  }

  std::vector<Stretch> stretches_of(LinkIndex l) const {
    std::vector<Pass> passes = passes_[l];
    std::sort(passes.begin(), passes.end(), [](const Pass& a, const Pass& b) { return a.from < b.from; });
    const Link& link = problem_.links[l];
    const Ps tick = problem_.model.tick;
    const Ps guard = std::max<Ps>(problem_.model.gap, problem_.model.guard_octets) * link.octet;
    const Ps wide = timing_.kind() == GateTiming::flowing ? problem_.model.margin : 0;
    Ps behind = passes.back().until + wide - spans_[l];  // end of what came last
    behind = (behind >= 0 ? behind + tick - 1 : behind) / tick * tick;
    std::vector<Stretch> all;
    for (const Pass& pass : passes) {
      const auto floor = [tick](Ps at) { return (at >= 0 ? at : at - tick + 1) / tick * tick; };
      const Ps begin = floor(pass.from - (pass.from_talker ? 0 : wide));
      const Ps end = floor(pass.until + wide + tick - 1);
      const Ps closed = std::max(floor(pass.from - (pass.from_talker ? 0 : wide) - guard), behind);
      const auto own = static_cast<std::uint8_t>(1u << pass.traffic_class);
      if (closed < begin) all.push_back({closed, begin, pass.waits ? std::uint8_t{0} : own});
      all.push_back({std::max(begin, behind), end, own});
      behind = end;
    }
    return joined(std::move(all));
  }

  static std::vector<Stretch> joined(std::vector<Stretch> all) {
    std::vector<Stretch> kept;
    for (const Stretch& each : all)
      if (!kept.empty() && kept.back().end == each.begin && kept.back().open == each.open)
        kept.back().end = each.end;
      else if (each.begin < each.end)
        kept.push_back(each);
    return kept;
  }

  /// All other classes are open where nothing else is said. The first stretches may begin before 0.
  std::vector<GateEntry> entries_of(const std::vector<Stretch>& stretches, Ps span) const {
    std::vector<GateEntry> entries;
    std::uint8_t scheduled = 0;
    for (const Stretch& each : stretches) scheduled = static_cast<std::uint8_t>(scheduled | each.open);
    const auto others = static_cast<std::uint8_t>(~scheduled);
    const auto add = [&](Ps interval, std::uint8_t open) {
      if (interval <= 0) return;
      if (!entries.empty() && entries.back().open == open)
        entries.back().interval += interval;
      else
        entries.push_back({interval, open});
    };
    std::vector<Stretch> cut;
    for (const Stretch& each : stretches) {
      if (each.begin < 0) {
        if (each.end > 0) cut.push_back({0, each.end, each.open});
        cut.push_back({each.begin + span, std::min(each.end, Ps{0}) + span, each.open});
      } else if (each.end > span) {
        cut.push_back({each.begin, span, each.open});
        cut.push_back({0, each.end - span, each.open});
      } else {
        cut.push_back(each);
      }
    }
    std::sort(cut.begin(), cut.end(), [](const Stretch& a, const Stretch& b) { return a.begin < b.begin; });
    Ps at = 0;
    for (const Stretch& each : cut) {
      add(each.begin - at, others);
      add(each.end - each.begin, each.open);
      at = each.end;
    }
    add(span - at, others);
    return entries;
  }

  /// Gives up the shortest time between two stretches. False if there is none left.
  static bool join_nearest(std::vector<Stretch>& stretches, Ps span) {
    const std::size_t count = stretches.size();
    std::size_t nearest = count;
    Ps shortest = longest_time;
    for (std::size_t i = 0; i < count; ++i) {
      const Ps before = i == 0 ? stretches[count - 1].end - span : stretches[i - 1].end;
      const Ps between = stretches[i].begin - before;
      if (between <= 0) continue;
      // Between windows of one class a list becomes shorter by two entries, not by one.
      const Ps price = stretches[i].open == stretches[i == 0 ? count - 1 : i - 1].open ? between : 2 * between;
      if (price < shortest) shortest = price, nearest = i;
    }
    if (nearest == count) return false;
    stretches[nearest].begin = nearest == 0 ? stretches[count - 1].end - span : stretches[nearest - 1].end;
    if (nearest != 0) stretches = joined(std::move(stretches));
    return true;
  }

  const Problem& problem_;
  Timing timing_;
  std::vector<std::vector<Pass>> passes_;
  std::vector<Ps> spans_;  ///< by link; 0: too long
};

}  // namespace

std::optional<std::string> make_gate_lists(const Problem& problem, Solution& solution, const ListLimits& limits) {
  ListMaker maker(problem, solution);
  solution.gates.clear();
  for (LinkIndex l = 0; l < problem.links.size(); ++l) {
    if (!maker.is_used(l)) continue;
    if (auto why = maker.list(l, limits, solution.gates[l])) {
      solution.gates.clear();
      return why;
    }
  }
  return std::nullopt;
}

std::size_t most_entries(const Solution& solution) {
  std::size_t most = 0;
  for (const auto& [link, list] : solution.gates) most = std::max(most, list.entries.size());
  return most;
}

}  // namespace takt::schedule
