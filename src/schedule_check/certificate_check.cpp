#include <fmt/format.h>

#include <algorithm>
#include <numeric>
#include <set>

#include "schedule_check/instance_check.hpp"
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

constexpr int128 no_way = static_cast<int128>(1) << 100;

/// Everything is worked out from the problem, by relaxing over all links until nothing changes.
class Proof {
 public:
  Proof(const Problem& problem, const Certificate& certificate) : problem_(problem), certificate_(certificate) {}

  std::string why_not() {
    for (const StreamIndex s : certificate_.streams)
      if (s >= problem_.streams.size()) return "there is no such stream";
    for (const auto& [s, k] : certificate_.jobs)
      if (s >= problem_.streams.size()) return "there is no such stream";
    for (const LinkIndex l : certificate_.links)
      if (l >= problem_.links.size()) return "there is no such link";
    if (std::set(certificate_.streams.begin(), certificate_.streams.end()).size() != certificate_.streams.size()) return "a stream is listed twice";
    if (std::set(certificate_.links.begin(), certificate_.links.end()).size() != certificate_.links.size()) return "a link is listed twice";
    if (std::set(certificate_.jobs.begin(), certificate_.jobs.end()).size() != certificate_.jobs.size()) return "a job is listed twice";
    switch (certificate_.kind) {
      case Certificate::Kind::latency: return latency();
      case Certificate::Kind::load: return load();
      case Certificate::Kind::interval: return interval();
      case Certificate::Kind::folded: return folded();
      case Certificate::Kind::pair: return pair();
    }
    return "no kind";
  }

 private:
  Ps frame(const Stream& s, const Link& l) const { return (Ps{s.octets} + problem_.model.preamble) * l.octet; }
  Ps step(const Stream& s, const Link& l) const { return frame(s, l) + problem_.model.gap * l.octet; }
  Ps work(const Stream& s, const Link& l) const { return s.frames * step(s, l); }
  Ps block(const Stream& s, const Link& l) const { return work(s, l) - problem_.model.gap * l.octet; }

  Ps onward(const Stream& s, const Link& l, const Link& next) const {
    const Ps head = l.cut_through && l.octet == next.octet ? Ps{*l.cut_through} * l.octet : frame(s, l);
    const Ps behind = (s.frames - 1) * (step(s, l) - step(s, next));
    return head + l.propagation + l.forwarding + (behind > 0 ? behind : 0);
  }

  bool usable(const Stream& s, LinkIndex l, const std::set<LinkIndex>& without) const {
    if (without.contains(l)) return false;
    if (s.route && std::find(s.route->begin(), s.route->end(), l) == s.route->end()) return false;
    return problem_.links[l].from == s.talker || problem_.nodes[problem_.links[l].from].is_bridge;
  }

  /// Earliest starts on all links, from the start at the talker or on `first`.
  std::vector<int128> starts(const Stream& s, const LinkIndex* first, const std::set<LinkIndex>& without) const {
    std::vector<int128> at(problem_.links.size(), no_way);
    std::vector<LinkIndex> fresh;
    for (LinkIndex l = 0; l < at.size(); ++l)
      if (first != nullptr ? l == *first : problem_.links[l].from == s.talker && usable(s, l, without)) at[l] = 0, fresh.push_back(l);
    while (!fresh.empty()) {
      std::vector<LinkIndex> next;
      for (const LinkIndex l : fresh) {
        if (!problem_.nodes[problem_.links[l].to].is_bridge) continue;
        for (LinkIndex m = 0; m < at.size(); ++m) {
          if (problem_.links[m].from != problem_.links[l].to || !usable(s, m, without)) continue;
          const int128 there = at[l] + onward(s, problem_.links[l], problem_.links[m]);
          if (there < at[m]) at[m] = there, next.push_back(m);
        }
      }
      fresh = std::move(next);
    }
    return at;
  }

  int128 arrival(const Stream& s, NodeIndex listener, const std::vector<int128>& at) const {
    int128 soonest = no_way;
    for (LinkIndex l = 0; l < at.size(); ++l)
      if (problem_.links[l].to == listener && at[l] != no_way) soonest = std::min<int128>(soonest, at[l] + block(s, problem_.links[l]) + problem_.links[l].propagation + problem_.links[l].forwarding);
    return soonest;
  }

  /// Listeners that are not reached without the links; in time, if the certificate asks for that.
  std::vector<NodeIndex> must_cross(const Stream& s, const std::vector<LinkIndex>& links) const {
    const auto at = starts(s, nullptr, {links.begin(), links.end()});
    std::vector<NodeIndex> found;
    for (const NodeIndex n : s.listeners) {
      const int128 least = arrival(s, n, at);
      if (least == no_way || (certificate_.in_time && is_late(s, least))) found.push_back(n);
    }
    return found;
  }

  static bool is_late(const Stream& s, int128 least) { return (s.latency && least > *s.latency) || (s.deadline && least > *s.deadline - s.release); }

  std::string latency() const {
    if (certificate_.streams.size() != 1) return "not one stream";
    const Stream& s = problem_.streams[certificate_.streams.front()];
    if (std::find(s.listeners.begin(), s.listeners.end(), certificate_.listener) == s.listeners.end()) return "no listener of the stream";
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
      for (const NodeIndex n : listeners) last = std::min<int128>(last, *stream.deadline + turn - arrival(stream, n, on));
      if (stream.release + turn + to_here[l] < certificate_.from || last + block(stream, link) > certificate_.until) return fmt::format("{} may be sent outside the interval", stream.name);
      sum += work(stream, link);
    }
    return sum > certificate_.until - certificate_.from ? "" : "the interval is long enough";
  }

  std::string folded() const {
    if (!problem_.model.is_strict) return "streams need not repeat with their periods";
    if (certificate_.links.size() != 1 || certificate_.streams.size() < 2 || certificate_.modulus < 1) return "not a link, a modulus and two streams";
    const Link& link = problem_.links[certificate_.links.front()];
    int128 sum = 0;   // of the modulus
    for (std::size_t i = 0; i < certificate_.streams.size(); ++i) {
      const Stream& a = problem_.streams[certificate_.streams[i]];
      if (must_cross(a, certificate_.links).empty()) return fmt::format("{} can avoid the link", a.name);
      for (std::size_t j = 0; j < i; ++j)
        if (certificate_.modulus % std::gcd(a.period, problem_.streams[certificate_.streams[j]].period) != 0) return "two periods have more in common than the modulus";
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
    if (!a.latency || !b.latency || a.listeners.size() != 1 || b.listeners.size() != 1) return "not two streams with a latency and one listener each";
    const auto at_a = starts(a, nullptr, {}), at_b = starts(b, nullptr, {});
    const int128 slack_a = *a.latency - arrival(a, a.listeners[0], at_a), slack_b = *b.latency - arrival(b, b.listeners[0], at_b);
    if (slack_a < 0 || slack_b < 0) return "one of them is too late even alone";
    // The fastest way takes each link that must be crossed; so a stream starts there from its earliest time on, and at most its slack later.
    const int128 every = std::gcd(a.period, b.period);
    struct Zone {
      int128 from, until;   // both outside
    };
    std::vector<Zone> zones;
    for (LinkIndex l = 0; l < problem_.links.size(); ++l) {
      if (at_a[l] == no_way || at_b[l] == no_way || must_cross(a, {l}).empty() || must_cross(b, {l}).empty()) continue;
      const Link& link = problem_.links[l];
      const int128 least = at_b[l] - at_a[l] - slack_a, most = at_b[l] - at_a[l] + slack_b;   // start of b less that of a, at equal phases
      if (-static_cast<int128>(work(b, link)) - least < work(a, link) - most) zones.push_back({-static_cast<int128>(work(b, link)) - least, work(a, link) - most});
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

std::string why_not_proved(const Problem& problem, const Certificate& certificate) { return Proof(problem, certificate).why_not(); }

}  // namespace takt::schedule_check
