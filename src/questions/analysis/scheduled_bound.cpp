// SPDX-License-Identifier: Apache-2.0
#include "analysis/scheduled_bound.hpp"

#include <algorithm>
#include <numeric>

namespace takt::analysis {
namespace {

constexpr std::size_t most_scheduled_frames = 2'000;
constexpr std::size_t most_intervals = 200'000;

struct ScheduledArrival {
  Ps earliest = 0;
  Ps latest = 0;
  Ps work = 0;
  std::size_t flow = 0;
};

}  // namespace

std::optional<Ps> hyperperiod(const std::vector<Ps>& periods, Ps cycle) {
  Ps all = cycle;
  for (const Ps period : periods) {
    const sim::int128 next = static_cast<sim::int128>(all / std::gcd(all, period)) * period;
    if (next > static_cast<sim::int128>(cycle) * 1'000'000) return std::nullopt;
    all = static_cast<Ps>(next);
  }
  return all;
}

std::optional<std::vector<Ps>> longest_waits(const std::vector<ScheduledFlow>& flows, Ps cycle,
                                             const std::vector<Ps>& ends, Ps busy, const StartFrom& start,
                                             const UnscheduledWork& others) {
  std::vector<Ps> periods;
  for (const ScheduledFlow& flow : flows) periods.push_back(flow.period);
  const std::optional<Ps> all = hyperperiod(periods, cycle);
  if (!all || flows.empty() || !is_bounded(busy)) return std::nullopt;
  // The frames of one hyperperiod, and before them those of a busy period; earlier ones may still come late.
  std::vector<ScheduledArrival> arrivals;
  for (std::size_t f = 0; f < flows.size(); ++f) {
    const ScheduledFlow& flow = flows[f];
    const Ps begin = -busy - flow.width - flow.period;
    const Ps first = flow.first % flow.period;
    if ((*all + flow.width - begin) / flow.period > static_cast<Ps>(most_scheduled_frames)) return std::nullopt;
    for (Ps at = first + (begin / flow.period - 1) * flow.period; at < *all + flow.width; at += flow.period)
      arrivals.push_back({at, at + flow.width, flow.work, f});
    if (arrivals.size() > most_scheduled_frames) return std::nullopt;
  }
  std::sort(arrivals.begin(), arrivals.end(),
            [](const ScheduledArrival& a, const ScheduledArrival& b) { return a.earliest < b.earliest; });
  std::vector<Ps> latest;
  for (const ScheduledArrival& arrival : arrivals) latest.push_back(arrival.latest);
  std::sort(latest.begin(), latest.end());
  std::vector<Ps> waits(flows.size(), 0);
  std::size_t looks = 0;
  for (const ScheduledArrival& mine : arrivals) {
    if (mine.earliest < 0 || mine.earliest >= *all) continue;
    std::vector<Ps> instants{mine.earliest};
    for (const ScheduledArrival& other : arrivals) {
      if (other.earliest > mine.earliest && other.earliest <= mine.latest) instants.push_back(other.earliest);
      for (const Ps jump : others.jumps)
        if (other.latest + jump > mine.earliest && other.latest + jump <= mine.latest)
          instants.push_back(other.latest + jump);
    }
    for (const Ps end : ends) {
      for (const Ps jump : others.jumps) {
        const Ps past = (mine.earliest - end - jump) % cycle;
        for (Ps at = mine.earliest - past - (past < 0 ? cycle : 0); at <= mine.latest; at += cycle)
          for (const Ps x : {at, at + 1})
            if (x > mine.earliest && x <= mine.latest) instants.push_back(x);
      }
      if (instants.size() > most_scheduled_frames) return std::nullopt;
    }
    for (const Ps x : instants) {
      std::vector<Ps> begins;
      for (const Ps jump : others.jumps) begins.push_back(x - jump);
      for (auto y = std::lower_bound(latest.begin(), latest.end(), x - busy); y != latest.end() && *y <= x; ++y)
        begins.push_back(*y);
      for (const Ps y : begins) {
        if (++looks > most_intervals) return std::nullopt;
        Ps before = -mine.work;  // it is among those that count
        for (const ScheduledArrival& other : arrivals) {
          if (other.earliest > x) break;
          if (other.latest >= y) before = sum(before, other.work);
        }
        before = sum(before, others.in(x - y));
        const Ps started = start(y, std::max<Ps>(0, before));
        if (!is_bounded(started)) return std::nullopt;
        waits[mine.flow] = std::max(waits[mine.flow], started + y - x);
      }
    }
  }
  return waits;
}

}  // namespace takt::analysis
