// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <numeric>
#include <set>

#include "schedule_check/clausal_check.hpp"
#include "schedule_check/instance_check.hpp"
#include "schedule_check/reach.hpp"
#include "sim/time.hpp"

namespace takt::schedule_check {
namespace {

using schedule::Certificate;
using schedule::Link;
using schedule::LinkIndex;
using schedule::NodeIndex;
using schedule::Problem;
using schedule::Ps;
using schedule::Stream;
using schedule::StreamIndex;
using sim::int128;

/// Everything is worked out from the problem.
class Proof : private Reach {
 public:
  Proof(const Problem& problem, const Certificate& certificate)
      : Reach(problem, certificate.in_time), problem_(problem), certificate_(certificate) {}

  std::string why_not() {
    for (const StreamIndex s : certificate_.streams)
      if (s >= problem_.streams.size()) return "there is no such stream";
    for (const auto& [s, k] : certificate_.jobs)
      if (s >= problem_.streams.size()) return "there is no such stream";
    for (const LinkIndex l : certificate_.links)
      if (l >= problem_.links.size()) return "there is no such link";
    if (std::set(certificate_.streams.begin(), certificate_.streams.end()).size() != certificate_.streams.size())
      return "a stream is listed twice";
    if (std::set(certificate_.links.begin(), certificate_.links.end()).size() != certificate_.links.size())
      return "a link is listed twice";
    if (std::set(certificate_.jobs.begin(), certificate_.jobs.end()).size() != certificate_.jobs.size())
      return "a job is listed twice";
    switch (certificate_.kind) {
      case Certificate::Kind::latency:
        return latency();
      case Certificate::Kind::load:
        return load();
      case Certificate::Kind::interval:
        return interval();
      case Certificate::Kind::folded:
        return folded();
      case Certificate::Kind::pair:
        return pair();
      case Certificate::Kind::clausal:
        return why_clauses_prove_nothing(problem_, certificate_);
    }
    return "no kind";
  }

 private:
  std::string latency() const {
    if (certificate_.streams.size() != 1) return "not one stream";
    const Stream& s = problem_.streams[certificate_.streams.front()];
    if (std::find(s.listeners.begin(), s.listeners.end(), certificate_.listener) == s.listeners.end())
      return "no listener of the stream";
    return is_late(s, arrival(s, certificate_.listener, starts(s, nullptr, {}))) ? "" : "it can be there in time";
  }

  std::string load() const {
    if (certificate_.links.empty() || certificate_.streams.empty()) return "nothing is listed";
    // Work by period as a sum of fractions over one denominator.
    int128 common = 1;
    for (const StreamIndex s : certificate_.streams) {
      common *= problem_.streams[s].period / std::gcd(static_cast<Ps>(common), problem_.streams[s].period);
      if (common > schedule::longest_time) return "the periods have no common multiple in reach";
    }
    int128 sum = 0;
    for (const StreamIndex s : certificate_.streams) {
      const Stream& stream = problem_.streams[s];
      if (must_cross(stream, certificate_.links).empty()) return fmt::format("{} can avoid the links", stream.name);
      Ps least = work(stream, problem_.links[certificate_.links.front()]);
      for (const LinkIndex l : certificate_.links) least = std::min(least, work(stream, problem_.links[l]));
      sum += static_cast<int128>(least) * (common / stream.period);
    }
    return sum > common * static_cast<int128>(certificate_.links.size()) ? "" : "the links can carry that";
  }

  std::string interval() const {
    if (certificate_.links.size() != 1 || certificate_.jobs.empty()) return "nothing is listed";
    const LinkIndex l = certificate_.links.front();
    const Link& link = problem_.links[l];
    int128 sum = -static_cast<int128>(problem_.model.gap) * link.octet;
    for (const auto& [s, k] : certificate_.jobs) {
      const Stream& stream = problem_.streams[s];
      if (!stream.deadline) return fmt::format("{} has no deadline", stream.name);
      const auto listeners = must_cross(stream, {l});
      if (listeners.empty()) return fmt::format("{} can avoid the link", stream.name);
      const int128 turn = static_cast<int128>(k) * stream.period;
      const auto to_here = starts(stream, nullptr, {});
      const auto on = starts(stream, &l, {});
      if (to_here[l] == no_way) return fmt::format("{} never comes to the link", stream.name);
      int128 last = no_way;
      for (const NodeIndex n : listeners)
        last = std::min<int128>(last, *stream.deadline + turn - arrival(stream, n, on));
      if (stream.release + turn + to_here[l] < certificate_.from || last + block(stream, link) > certificate_.until)
        return fmt::format("{} may be sent outside the interval", stream.name);
      sum += work(stream, link);
    }
    return sum > certificate_.until - certificate_.from ? "" : "the interval is long enough";
  }

  std::string folded() const {
    if (!problem_.model.is_strict) return "streams need not repeat with their periods";
    if (certificate_.links.size() != 1 || certificate_.streams.size() < 2 || certificate_.modulus < 1)
      return "not a link, a modulus and two streams";
    const Link& link = problem_.links[certificate_.links.front()];
    int128 sum = 0;  // of the modulus
    for (std::size_t i = 0; i < certificate_.streams.size(); ++i) {
      const Stream& a = problem_.streams[certificate_.streams[i]];
      if (must_cross(a, certificate_.links).empty()) return fmt::format("{} can avoid the link", a.name);
      for (std::size_t j = 0; j < i; ++j)
        if (certificate_.modulus % std::gcd(a.period, problem_.streams[certificate_.streams[j]].period) != 0)
          return "two periods have more in common than the modulus";
      sum += static_cast<int128>(work(a, link)) * (certificate_.modulus / std::gcd(a.period, certificate_.modulus));
    }
    return sum > certificate_.modulus ? "" : "the modulus is long enough";
  }

  /// Each phase of the second against the first, less what is free: what is left is walked from end to end.
  std::string pair() const {
    if (!problem_.model.is_strict) return "streams need not repeat with their periods";
    if (certificate_.streams.size() != 2) return "not two streams";
    const Stream& a = problem_.streams[certificate_.streams[0]];
    const Stream& b = problem_.streams[certificate_.streams[1]];
    if (!a.latency || !b.latency || a.listeners.size() != 1 || b.listeners.size() != 1)
      return "not two streams with a latency and one listener each";
    const auto at_a = starts(a, nullptr, {}), at_b = starts(b, nullptr, {});
    const int128 slack_a = *a.latency - arrival(a, a.listeners[0], at_a),
                 slack_b = *b.latency - arrival(b, b.listeners[0], at_b);
    if (slack_a < 0 || slack_b < 0) return "one of them is too late even alone";
    // The fastest way takes each link that must be crossed; so a stream starts there from its earliest time on, and at
    // most its slack later.
    const int128 every = std::gcd(a.period, b.period);
    struct Zone {
      int128 from, until;  // both outside
    };
    std::vector<Zone> zones;
    for (LinkIndex l = 0; l < problem_.links.size(); ++l) {
      if (at_a[l] == no_way || at_b[l] == no_way || must_cross(a, {l}).empty() || must_cross(b, {l}).empty()) continue;
      const Link& link = problem_.links[l];
      const int128 least = at_b[l] - at_a[l] - slack_a,
                   most = at_b[l] - at_a[l] + slack_b;  // start of b less that of a, at equal phases
      if (-static_cast<int128>(work(b, link)) - least < work(a, link) - most)
        zones.push_back({-static_cast<int128>(work(b, link)) - least, work(a, link) - most});
    }
    for (int128 phase = 0; phase < every;) {
      int128 next = phase;
      for (const Zone& zone : zones) {
        // The copy of the zone that begins last before the phase.
        int128 turns = (phase - zone.from) / every;
        while (zone.from + turns * every >= phase) --turns;
        while (zone.from + (turns + 1) * every < phase) ++turns;
        next = std::max(next, zone.until + turns * every);
      }
      if (next == phase) return "they need not meet";
      phase = next;
    }
    return "";
  }

  const Problem& problem_;
  const Certificate& certificate_;
};

}  // namespace

std::string why_not_proved(const Problem& problem, const Certificate& certificate) {
  return Proof(problem, certificate).why_not();
}

schedule::Decision decide_judged(const Problem& problem, schedule::SearchOptions options,
                                 schedule::Objective objective) {
  options.judge = why_not_proved;
  return schedule::decide(problem, options, objective);
}

}  // namespace takt::schedule_check
