// SPDX-License-Identifier: Apache-2.0
#include "schedule_check/clausal_check.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <numeric>
#include <optional>
#include <utility>

#include "schedule_check/reach.hpp"

namespace takt::schedule_check {
namespace {

using schedule::Clause;
using schedule::LinkIndex;
using schedule::Ps;
using schedule::StreamIndex;
using schedule::Threshold;
using sim::int128;

int128 rest(int128 at, int128 modulus) { return (at % modulus + modulus) % modulus; }

/// What a number may be, both ends included.
struct Bounds {
  int128 low = -no_way, high = no_way;
  bool is_empty() const { return low > high; }
};

/// What the problem says of one of the streams. Its number u on a link: the start there, less the least time from the
/// start at the talker to there.
struct Fact {
  Ps period = 0;
  Ps slack = 0;  ///< u on any link is at most so much more than on any other; later links have no lesser one
  Bounds u;
  std::vector<std::pair<int128, LinkIndex>> order;  ///< links that it must cross, by that least time
  std::map<LinkIndex, int128> lag;
};

class ClausalProof {
 public:
  ClausalProof(const schedule::Problem& problem, const schedule::Certificate& certificate)
      : problem_(problem),
        certificate_(certificate),
        proof_(certificate.clauses),
        reach_(problem, certificate.in_time) {}

  std::string why_not() {
    if (!problem_.model.is_strict) return "streams need not repeat with their periods";
    if (certificate_.streams.size() < 2) return "not two streams";
    for (const StreamIndex s : certificate_.streams)
      if (std::string why = learn(s); !why.empty()) return why;
    if (std::string why = place_in_time(); !why.empty()) return why;
    for (const Threshold& threshold : proof_.thresholds) {
      const auto fact = facts_.find(threshold.stream);
      if (fact == facts_.end()) return "a threshold is of a stream that is not listed";
      if (!fact->second.lag.contains(threshold.link))
        return fmt::format("{} can avoid a link", problem_.streams[threshold.stream].name);
      if (threshold.modulus < 0 || threshold.modulus % unit_ != 0) return "a modulus is none";
    }
    for (std::size_t i = 0; i < proof_.axioms.size(); ++i) {
      if (!has_known_literals(proof_.axioms[i])) return "a literal is of no threshold";
      if (!is_true(proof_.axioms[i])) return fmt::format("axiom {} need not hold", i);
    }
    for (std::size_t i = 0; i < proof_.steps.size(); ++i) {
      if (!has_known_literals(proof_.steps[i].clause)) return "a literal is of no threshold";
      if (!follows(i)) return fmt::format("step {} does not follow", i);
    }
    const bool ends = proof_.steps.empty() ? !proof_.axioms.empty() && proof_.axioms.back().empty()
                                           : proof_.steps.back().clause.empty();
    return ends ? "" : "it ends in no contradiction";
  }

 private:
  std::string learn(StreamIndex s) {
    const schedule::Stream& stream = problem_.streams[s];
    if (stream.listeners.size() != 1 || (!stream.latency && !stream.deadline))
      return fmt::format("{} has not one listener and a time to be there", stream.name);
    const auto at = reach_.starts(stream, nullptr, {});
    const int128 arrival = reach_.arrival(stream, stream.listeners.front(), at);
    if (arrival == no_way) return fmt::format("no way leads {} to its listener", stream.name);
    // The fastest way takes each link that must be crossed, so these stand in one order, and what is lost before one
    // cannot be won back behind it.
    const int128 slack = stream.latency ? *stream.latency - arrival : *stream.deadline - stream.release - arrival;
    Fact fact{stream.period,
              static_cast<Ps>(slack),
              {stream.release, static_cast<int128>(stream.release) + stream.period - 1},
              {},
              {}};
    if (stream.deadline) fact.u.high = std::min<int128>(fact.u.high, *stream.deadline - arrival);
    if (slack < 0 || fact.u.is_empty()) return fmt::format("{} is too late even alone", stream.name);
    for (LinkIndex l = 0; l < problem_.links.size(); ++l)
      if (at[l] != no_way && !reach_.must_cross(stream, {l}).empty()) {
        fact.order.emplace_back(at[l], l);
        fact.lag[l] = at[l];
      }
    std::sort(fact.order.begin(), fact.order.end());
    for (std::size_t i = 1; i < fact.order.size(); ++i)
      if (fact.order[i].first == fact.order[i - 1].first)
        return fmt::format("{} may be on two links at one time", stream.name);
    facts_.emplace(s, std::move(fact));
    return "";
  }

  std::vector<LinkIndex> shared(const Fact& a, const Fact& b) const {
    std::vector<LinkIndex> links;
    for (const auto& [l, lag] : a.lag)
      if (b.lag.contains(l)) links.push_back(l);
    return links;
  }

  /// Domains, and the unit: if there are starts at all then also ones of which each is rounded down to a multiple of
  /// it, since all that two starts are compared with is a multiple.
  std::string place_in_time() {
    bool has_deadline = false;
    for (const StreamIndex s : certificate_.streams) has_deadline = has_deadline || problem_.streams[s].deadline;
    if (proof_.anchor && (has_deadline || !facts_.contains(*proof_.anchor)))
      return "the stream that begins at 0 cannot be chosen so";
    Ps unit = 0;
    for (auto& [s, fact] : facts_) {
      unit = std::gcd(unit, std::gcd(fact.period, fact.slack));
      if (has_deadline) unit = std::gcd(unit, problem_.streams[s].release);
      for (const auto& [other, theirs] : facts_)
        if (other != s)
          for (const LinkIndex l : shared(fact, theirs))
            unit = std::gcd(
                unit, std::gcd(static_cast<Ps>(fact.lag[l]), reach_.work(problem_.streams[s], problem_.links[l])));
    }
    unit_ = unit;
    if (unit_ <= 0) return "there is no unit";
    for (auto& [s, fact] : facts_) {
      if (!has_deadline) {
        // Whoever else crosses its links sees of the start only the rest by what the periods have in common.
        Ps modulus = 1;
        for (const auto& [other, theirs] : facts_)
          if (other != s && !shared(fact, theirs).empty())
            modulus = std::lcm(modulus, std::gcd(fact.period, theirs.period));
        fact.u = {0, modulus - 1};
        if (proof_.anchor == s) fact.u = {0, 0};
      }
      fact.u.high += fact.slack;
      fact.u = on_grid(fact.u);
    }
    return "";
  }

  Bounds on_grid(Bounds bounds) const {
    return {bounds.low + rest(-bounds.low, unit_), bounds.high - rest(bounds.high, unit_)};
  }

  bool has_known_literals(const Clause& clause) const {
    return std::all_of(clause.begin(), clause.end(), [&](std::int32_t literal) {
      return literal != 0 && literal != INT32_MIN &&
             static_cast<std::size_t>(literal > 0 ? literal : -literal) <= proof_.thresholds.size();
    });
  }

  /// A number that a clause speaks of. Where a stream may not wait it is the same on all links.
  struct Key {
    LinkIndex link;
    Ps modulus;
    bool operator<(const Key& other) const { return std::pair(link, modulus) < std::pair(other.link, other.modulus); }
  };
  using Claims = std::map<Key, Bounds>;

  /// If no literal held: what would its numbers be? It holds if they can be nothing.
  bool is_true(const Clause& clause) const {
    std::map<StreamIndex, Claims> claims;
    for (const std::int32_t literal : clause) {
      const Threshold& threshold = proof_.thresholds[static_cast<std::size_t>(literal > 0 ? literal : -literal) - 1];
      const Fact& fact = facts_.at(threshold.stream);
      const Key key{fact.slack > 0 ? threshold.link : fact.order.front().second, threshold.modulus};
      const auto [place, is_new] = claims[threshold.stream].try_emplace(key);
      Bounds& bounds = place->second;
      if (is_new) bounds = key.modulus == 0 ? fact.u : Bounds{0, key.modulus - 1};
      if (literal > 0)
        bounds.high = std::min<int128>(bounds.high, static_cast<int128>(threshold.at) - 1);
      else
        bounds.low = std::max<int128>(bounds.low, threshold.at);
      bounds = on_grid(bounds);
    }
    for (const auto& [s, own] : claims)
      if (is_nothing(facts_.at(s), own)) return true;
    for (const auto& [s, own] : claims)
      if (own.size() != 1) return false;
    if (claims.size() == 2) return meet(*claims.begin(), *claims.rbegin());
    // Of one stream: it meets another one wherever that may be; of none: some two always meet.
    for (const auto& [a, fact_a] : facts_) {
      if (claims.size() > 1 || (claims.size() == 1 && !claims.contains(a))) continue;
      for (const auto& [b, fact_b] : facts_) {
        if (a == b) continue;
        for (const LinkIndex l : shared(fact_a, fact_b)) {
          const std::pair<const StreamIndex, Claims> one{a, claims.empty() ? anywhere(fact_a, l) : claims.at(a)},
              two{b, anywhere(fact_b, l)};
          if (meet(one, two)) return true;
        }
      }
    }
    return false;
  }

  static Claims anywhere(const Fact& fact, LinkIndex link) {
    return {{Key{fact.slack > 0 ? link : fact.order.front().second, 0}, fact.u}};
  }

  bool is_nothing(const Fact& fact, const Claims& claims) const {
    for (const auto& [key, bounds] : claims)
      if (bounds.is_empty()) return true;
    // From link to link u does not shrink, and from the first to the last it grows by the slack at most.
    std::map<LinkIndex, Bounds> by_link;
    for (const auto& [lag, link] : fact.order) {
      const auto claim = claims.find({fact.slack > 0 ? link : fact.order.front().second, 0});
      by_link[link] = claim == claims.end() ? fact.u : claim->second;
    }
    int128 low = -no_way, high = no_way;
    for (const auto& [lag, link] : fact.order)
      low = std::max(low, by_link[link].low), high = std::min(high, by_link[link].high);
    for (auto& [link, bounds] : by_link)
      bounds = {std::max(bounds.low, low - fact.slack), std::min(bounds.high, high + fact.slack)};
    int128 least = -no_way, most = no_way;
    for (const auto& [lag, link] : fact.order) by_link[link].low = least = std::max(least, by_link[link].low);
    for (auto each = fact.order.rbegin(); each != fact.order.rend(); ++each)
      by_link[each->second].high = most = std::min(most, by_link[each->second].high);
    for (const auto& [link, bounds] : by_link)
      if (bounds.is_empty()) return true;
    for (const auto& [key, bounds] : claims) {
      if (key.modulus == 0) continue;
      // The first number from the low end on whose rest is within the claim.
      const Bounds& own = by_link[key.link];
      const int128 behind = rest(own.low, key.modulus);
      const int128 first = behind > bounds.high ? own.low + key.modulus - behind + bounds.low
                                                : own.low + std::max<int128>(0, bounds.low - behind);
      if (first > own.high) return true;
    }
    return false;
  }

  /// Whether two streams meet on a link whatever their numbers within the claims.
  bool meet(const std::pair<const StreamIndex, Claims>& one, const std::pair<const StreamIndex, Claims>& two) const {
    const StreamIndex a = one.first, b = two.first;
    const Claims& claims_a = one.second;
    const Claims& claims_b = two.second;
    const Fact& fact_a = facts_.at(a);
    const Fact& fact_b = facts_.at(b);
    const Key key_a = claims_a.begin()->first, key_b = claims_b.begin()->first;
    const Bounds bounds_a = claims_a.begin()->second, bounds_b = claims_b.begin()->second;
    const int128 every = std::gcd(fact_a.period, fact_b.period);
    if (key_a.modulus % every != 0 || key_b.modulus % every != 0) return false;
    std::vector<LinkIndex> links = shared(fact_a, fact_b);
    // A claim about another link says nothing of this one.
    std::erase_if(links, [&](LinkIndex l) {
      return (fact_a.slack > 0 && l != key_a.link) || (fact_b.slack > 0 && l != key_b.link);
    });
    std::vector<Bounds> zones;  // of the number of b less that of a
    for (const LinkIndex l : links) {
      const schedule::Link& link = problem_.links[l];
      const int128 apart = fact_b.lag.at(l) - fact_a.lag.at(l);
      zones.push_back({-static_cast<int128>(reach_.work(problem_.streams[b], link)) - apart + 1,
                       reach_.work(problem_.streams[a], link) - apart - 1});
    }
    const int128 low = bounds_b.low - bounds_a.high, high = bounds_b.high - bounds_a.low;
    for (int128 d = low; d <= high && d < low + every;) {
      int128 next = d;
      for (const Bounds& zone : zones)
        if (const int128 inside = rest(d - zone.low, every); zone.low + inside <= zone.high)
          next = std::max(next, d + (zone.high - zone.low - inside) + 1);
      if (next == d) return false;
      d = next + rest(-next, unit_);
    }
    return true;
  }

  bool follows(std::size_t index) const {
    const auto& [clause, from] = proof_.steps[index];
    std::map<std::int32_t, bool> value;
    for (const std::int32_t literal : clause) value[-literal] = true, value[literal] = false;
    for (std::size_t i = 0; i < from.size(); ++i) {
      if (from[i] >= proof_.axioms.size() + index) return false;
      const Clause& reason =
          from[i] < proof_.axioms.size() ? proof_.axioms[from[i]] : proof_.steps[from[i] - proof_.axioms.size()].clause;
      std::optional<std::int32_t> open;
      for (const std::int32_t literal : reason) {
        const auto known = value.find(literal);
        if (known != value.end() && !known->second) continue;
        if (known != value.end() || (open && *open != literal)) return false;  // it holds, or leaves two
        open = literal;
      }
      if (!open) return true;
      value[*open] = true;
      value[-*open] = false;
    }
    return false;
  }

  const schedule::Problem& problem_;
  const schedule::Certificate& certificate_;
  const schedule::ClausalProof& proof_;
  Reach reach_;
  std::map<StreamIndex, Fact> facts_;
  Ps unit_ = 0;
};

}  // namespace

std::string why_clauses_prove_nothing(const schedule::Problem& problem, const schedule::Certificate& certificate) {
  return ClausalProof(problem, certificate).why_not();
}

}  // namespace takt::schedule_check
