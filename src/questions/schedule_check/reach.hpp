// SPDX-License-Identifier: Apache-2.0
// Where a stream can be, and how soon: worked out from the problem by relaxing over links until nothing changes, for
// those who check certificates.
#pragma once

#include <algorithm>
#include <set>
#include <vector>

#include "schedule/problem.hpp"
#include "sim/time.hpp"

namespace takt::schedule_check {

inline constexpr sim::int128 no_way = static_cast<sim::int128>(1) << 100;

class Reach {
 public:
  /// `in_time`: a way that is too slow for latency or deadline is none.
  Reach(const schedule::Problem& problem, bool in_time) : problem_(problem), in_time_(in_time) {}

  schedule::Ps frame(const schedule::Stream& s, const schedule::Link& l) const {
    return (schedule::Ps{s.octets} + problem_.model.preamble) * l.octet;
  }
  schedule::Ps step(const schedule::Stream& s, const schedule::Link& l) const {
    return frame(s, l) + problem_.model.gap * l.octet;
  }
  schedule::Ps work(const schedule::Stream& s, const schedule::Link& l) const { return s.frames * step(s, l); }
  schedule::Ps block(const schedule::Stream& s, const schedule::Link& l) const {
    return work(s, l) - problem_.model.gap * l.octet;
  }

  schedule::Ps onward(const schedule::Stream& s, const schedule::Link& l, const schedule::Link& next) const {
    const schedule::Ps head =
        l.cut_through && l.octet == next.octet ? schedule::Ps{*l.cut_through} * l.octet : frame(s, l);
    const schedule::Ps behind = (s.frames - 1) * (step(s, l) - step(s, next));
    return head + l.propagation + l.forwarding + (behind > 0 ? behind : 0);
  }

  bool usable(const schedule::Stream& s, schedule::LinkIndex l, const std::set<schedule::LinkIndex>& without) const {
    if (without.contains(l)) return false;
    if (s.route && std::find(s.route->begin(), s.route->end(), l) == s.route->end()) return false;
    return problem_.links[l].from == s.talker || problem_.nodes[problem_.links[l].from].is_bridge;
  }

  /// Earliest starts on all links, from the start at the talker or on `first`.
  std::vector<sim::int128> starts(const schedule::Stream& s, const schedule::LinkIndex* first,
                                  const std::set<schedule::LinkIndex>& without) const {
    std::vector<sim::int128> at(problem_.links.size(), no_way);
    std::vector<schedule::LinkIndex> fresh;
    for (schedule::LinkIndex l = 0; l < at.size(); ++l)
      if (first != nullptr ? l == *first : problem_.links[l].from == s.talker && usable(s, l, without))
        at[l] = 0, fresh.push_back(l);
    while (!fresh.empty()) {
      std::vector<schedule::LinkIndex> next;
      for (const schedule::LinkIndex l : fresh) {
        if (!problem_.nodes[problem_.links[l].to].is_bridge) continue;
        for (schedule::LinkIndex m = 0; m < at.size(); ++m) {
          if (problem_.links[m].from != problem_.links[l].to || !usable(s, m, without)) continue;
          const sim::int128 there = at[l] + onward(s, problem_.links[l], problem_.links[m]);
          if (there < at[m]) at[m] = there, next.push_back(m);
        }
      }
      fresh = std::move(next);
    }
    return at;
  }

  sim::int128 arrival(const schedule::Stream& s, schedule::NodeIndex listener,
                      const std::vector<sim::int128>& at) const {
    sim::int128 soonest = no_way;
    for (schedule::LinkIndex l = 0; l < at.size(); ++l)
      if (problem_.links[l].to == listener && at[l] != no_way)
        soonest = std::min<sim::int128>(soonest, at[l] + block(s, problem_.links[l]) + problem_.links[l].propagation +
                                                     problem_.links[l].forwarding);
    return soonest;
  }

  /// Listeners that are not reached without the links; in time, if the certificate asks for that.
  std::vector<schedule::NodeIndex> must_cross(const schedule::Stream& s,
                                              const std::vector<schedule::LinkIndex>& links) const {
    const auto at = starts(s, nullptr, {links.begin(), links.end()});
    std::vector<schedule::NodeIndex> found;
    for (const schedule::NodeIndex n : s.listeners) {
      const sim::int128 least = arrival(s, n, at);
      if (least == no_way || (in_time_ && is_late(s, least))) found.push_back(n);
    }
    return found;
  }

  static bool is_late(const schedule::Stream& s, sim::int128 least) {
    return (s.latency && least > *s.latency) || (s.deadline && least > *s.deadline - s.release);
  }

 private:
  const schedule::Problem& problem_;
  bool in_time_;
};

}  // namespace takt::schedule_check
