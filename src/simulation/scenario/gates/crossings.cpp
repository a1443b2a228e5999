// SPDX-License-Identifier: Apache-2.0
#include "scenario/gates/crossings.hpp"

#include <algorithm>
#include <utility>

#include "sim/check.hpp"

namespace takt::scenario {
namespace {

using sim::Duration;

Duration ceil_ns(Duration d) { return -floor_ns(-d); }

}  // namespace

Duration floor_ns(Duration d) { return Duration::from_ps(d.ps() - modulo(d.ps(), 1'000)); }

Crossings::Crossings(const GateProblem& problem, Waiting waiting)
    : problem_(&problem), waiting_(waiting), at_(problem.ports.size()) {
  for (std::uint32_t s = 0; s < problem.streams.size(); ++s)
    for (std::uint32_t h = 0; h < problem.streams[s].hops.size(); ++h)
      at_[problem.streams[s].hops[h].port].push_back({s, h});
  for (std::uint32_t s = 0; s < problem.streams.size(); ++s) follow(s);
}

Duration Crossings::earliest(Crossing c) const {
  const Duration early = waiting_ == Waiting::at_gates ? Duration() : problem_->streams[c.stream].early;
  return window(c).start - early - (hop(c).previous ? problem_->margin : Duration());
}

Duration Crossings::free_again(Crossing c) const {
  return window(c).start + hop(c).transmission + problem_->margin + problem_->ports[hop(c).port].gap;
}

bool Crossings::follows(Crossing later, Crossing earlier) const {
  if (problem_->streams[later.stream].train != problem_->streams[earlier.stream].train ||
      later.stream == earlier.stream)
    return false;
  const auto& a = hop(earlier).previous;
  const auto& b = hop(later).previous;
  if (!a || !b) return !a && !b && earlier.stream < later.stream;
  const Crossing earlier_before{earlier.stream, *a};
  const Crossing later_before{later.stream, *b};
  return hop(earlier_before).port == hop(later_before).port && follows(later_before, earlier_before);
}

bool Crossings::is_same_frame(Crossing later, Crossing earlier) const {
  if (later.stream != earlier.stream || later.hop == earlier.hop) return false;
  const bool is_behind_merge = hop(later).is_merged && hop(earlier).is_merged;
  if (!is_behind_merge && (hop(later).previous || hop(earlier).previous)) return false;
  return std::pair(window(later).start, later.hop) > std::pair(window(earlier).start, earlier.hop);
}

bool Crossings::share_a_queue(Crossing a, Crossing b) const {
  if (waiting_ == Waiting::nowhere || hop(a).previous || hop(b).previous ||
      hop(a).traffic_class != hop(b).traffic_class)
    return false;
  if (problem_->streams[a.stream].train == problem_->streams[b.stream].train) return false;
  // Otherwise they come at two instants; at one their windows overlap.
  return problem_->streams[a.stream].early > Duration() || problem_->streams[b.stream].early > Duration();
}

bool Crossings::come_in_any_order(Crossing a, Crossing b, std::int64_t common) const {
  if (!share_a_queue(a, b)) return false;
  const ScheduledStream& first = problem_->streams[a.stream];
  const ScheduledStream& second = problem_->streams[b.stream];
  const std::int64_t distance = modulo((second.release - second.early - first.release + first.early).ps(), common);
  return first.early.ps() >= distance || distance + second.early.ps() >= common;
}

void Crossings::follow(std::uint32_t s) {
  const ScheduledStream& each = problem_->streams[s];
  const bool is_gated = waiting_ == Waiting::at_gates;
  windows_.emplace_back();
  for (std::uint32_t h = 0; h < each.hops.size(); ++h) {
    const ScheduledHop& at = each.hops[h];
    Duration start = is_gated ? ceil_ns(each.release) : each.release;
    if (at.previous) {
      TAKT_CHECK(*at.previous < h, "hops stand in the order of the way");
      start = windows_[s][*at.previous].start + each.hops[*at.previous].transmission + each.hops[*at.previous].behind -
              at.ahead;
    }
    start += at.wait;
    for (const Crossing& other : at_[at.port])
      if (other.stream < s && follows({s, h}, other))
        start = std::max(start, window(other).start + hop(other).transmission + problem_->ports[at.port].gap);
    if (is_gated && !at.previous)  // copies that the talker sends by one port
      for (std::uint32_t copy = 0; copy < h; ++copy)
        if (!each.hops[copy].previous && each.hops[copy].port == at.port)
          start =
              std::max(start, windows_[s][copy].start + each.hops[copy].transmission + problem_->ports[at.port].gap);
    const Duration early = at.previous ? problem_->margin : Duration();
    windows_[s].push_back({start, floor_ns(start - early), ceil_ns(start + at.transmission + problem_->margin)});
  }
}

}  // namespace takt::scenario
