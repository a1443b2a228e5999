// SPDX-License-Identifier: Apache-2.0
#include "schedule_check/instance_check.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <numeric>
#include <optional>
#include <set>
#include <utility>

#include "sim/time.hpp"

namespace takt::schedule_check {
namespace {

using schedule::Link;
using schedule::Problem;
using schedule::Ps;
using schedule::Solution;
using schedule::Stream;
using sim::int128;

/// A stream on a link.
struct OnLink {
  const Stream* stream = nullptr;
  const Link* link = nullptr;
  std::ptrdiff_t before = -1;  ///< passage of the same stream on the link that leads here; -1 at the talker
  std::size_t hop = 0;         ///< in the route
  std::vector<Ps> starts;      ///< of repetitions; one: all others follow by the period
  std::vector<Ps> there;       ///< when the first frame of each is ready to be sent
  Ps frame = 0, step = 0, block = 0;
  Ps comes_every = 0;  ///< at which the frames of a train come
  int traffic_class = 0;
};

/// One repetition on a link.
struct Turn {
  Ps start = 0;
  Ps there = 0;
  const OnLink* passage = nullptr;
};

constexpr Ps most_turns = 4'000'000;

class Judge {
 public:
  Judge(const Problem& problem, const Solution& solution, std::size_t most)
      : problem_(problem), solution_(solution), most_(most) {
    margin_ = problem.model.margin;
    is_held_ = solution.timing == schedule::GateTiming::held;
  }

  std::vector<std::string> run() {
    if (solution_.streams.size() != problem_.streams.size()) {
      say("stream: {} are scheduled of {}", solution_.streams.size(), problem_.streams.size());
      return std::move(wrong_);
    }
    for (std::size_t s = 0; s < problem_.streams.size() && wrong_.size() < most_; ++s) judge_stream(s);
    std::vector<std::vector<const OnLink*>> by_link(problem_.links.size());
    for (const auto& passages : passages_)
      for (const OnLink& each : passages)
        by_link[static_cast<std::size_t>(each.link - problem_.links.data())].push_back(&each);
    for (std::size_t l = 0; l < by_link.size() && wrong_.size() < most_; ++l)
      if (!by_link[l].empty()) judge_link(static_cast<schedule::LinkIndex>(l), by_link[l]);
    return std::move(wrong_);
  }

 private:
  template <class... Args>
  void say(fmt::format_string<Args...> text, Args&&... args) {
    if (wrong_.size() < most_) wrong_.push_back(fmt::format(text, std::forward<Args>(args)...));
  }

  void judge_stream(std::size_t s) {
    const Stream& stream = problem_.streams[s];
    if (!solution_.streams[s]) return say("stream: {} is not scheduled", stream.name);
    const schedule::Placement& given = *solution_.streams[s];
    if (stream.route && *stream.route != given.route)
      return say("route: {} does not take the prescribed one", stream.name);
    if (given.starts.size() != given.route.size() || given.classes.size() != given.route.size())
      return say("start: {} has not as many as links", stream.name);
    std::vector<OnLink> passages;
    std::map<schedule::NodeIndex, std::ptrdiff_t> entered{{stream.talker, -1}};
    std::set<schedule::NodeIndex> left;
    for (std::size_t i = 0; i < given.route.size(); ++i) {
      if (given.route[i] >= problem_.links.size()) return say("route: {} takes a link that is not there", stream.name);
      const Link& link = problem_.links[given.route[i]];
      const auto from = entered.find(link.from);
      if (from == entered.end()) return say("route: {} takes {} before it is there", stream.name, link.name);
      if (entered.contains(link.to)) return say("route: {} comes twice to the end of {}", stream.name, link.name);
      if (from->second >= 0 && !problem_.nodes[link.from].is_bridge)
        return say("route: {} goes through an end station before {}", stream.name, link.name);
      OnLink passage;
      passage.stream = &stream;
      passage.link = &link;
      passage.before = from->second;
      passage.hop = i;
      passage.frame = (Ps{stream.octets} + problem_.model.preamble) * link.octet;
      passage.step = passage.frame + problem_.model.gap * link.octet;
      passage.block = passage.frame + (stream.frames - 1) * passage.step;
      passage.comes_every = passage.before < 0 ? passage.step : passages[static_cast<std::size_t>(passage.before)].step;
      passage.traffic_class = given.classes[i];
      passage.starts = given.starts[i];
      if (passage.traffic_class > 7)
        return say("class: {} has class {} on {}", stream.name, passage.traffic_class, link.name);
      if (passage.starts.empty()) return say("start: {} has none on {}", stream.name, link.name);
      left.insert(link.from);
      entered[link.to] = static_cast<std::ptrdiff_t>(i);
      passages.push_back(std::move(passage));
    }
    for (const auto listener : stream.listeners)
      if (!entered.contains(listener) || entered[listener] < 0)
        return say("route: {} does not come to {}", stream.name, problem_.nodes[listener].name);
    for (const auto& [node, by] : entered)
      if (!left.contains(node) &&
          std::find(stream.listeners.begin(), stream.listeners.end(), node) == stream.listeners.end())
        return say("route: {} ends at {}, which is no listener", stream.name, problem_.nodes[node].name);
    std::size_t repetitions = 1;
    for (const OnLink& each : passages) repetitions = std::max(repetitions, each.starts.size());
    for (OnLink& each : passages) {
      if (each.starts.size() == 1)
        for (std::size_t k = 1; k < repetitions; ++k)
          each.starts.push_back(each.starts[0] + static_cast<Ps>(k) * stream.period);
      if (each.starts.size() != repetitions) return say("start: {} has different numbers of them", stream.name);
      for (std::size_t k = 0; k < repetitions && problem_.model.is_strict; ++k)
        if (each.starts[k] - each.starts[0] != static_cast<Ps>(k) * stream.period)
          return say("strict: {} does not repeat with its period on {}", stream.name, each.link->name);
    }
    if (repetitions > 1 && (!common() || *common() / stream.period != static_cast<Ps>(repetitions)))
      return say("start: {} has {} repetitions", stream.name, repetitions);
    judge_times(stream, passages, repetitions);
    passages_.push_back(std::move(passages));
  }

  void judge_times(const Stream& stream, std::vector<OnLink>& passages, std::size_t repetitions) {
    std::map<schedule::NodeIndex, std::pair<Ps, Ps>> arrivals;  // by listener: least and greatest, less k periods
    for (std::size_t k = 0; k < repetitions; ++k) {
      const Ps turn = static_cast<Ps>(k) * stream.period;
      std::optional<Ps> begin;
      for (const OnLink& each : passages)
        if (each.before < 0) begin = begin ? std::min(*begin, each.starts[k]) : each.starts[k];
      for (OnLink& each : passages) {
        const Ps start = each.starts[k];
        Ps there = start;
        if (each.before < 0) {
          if (start < stream.release + turn)
            say("release: {} starts at {} ps, before {} ps", stream.name, start, stream.release + turn);
        } else {
          const OnLink& last = passages[static_cast<std::size_t>(each.before)];
          const bool cuts = last.link->cut_through.has_value() && last.link->octet == each.link->octet;
          there = last.starts[k] + (cuts ? Ps{*last.link->cut_through} * last.link->octet : last.frame) +
                  last.link->propagation + last.link->forwarding;
          // The first frame is there, and so is each of the others when its turn comes: it is enough to look at the
          // last.
          const Ps slack = is_held_ ? margin_ : 0;
          const Ps last_there = there + (stream.frames - 1) * last.step,
                   last_start = start + (stream.frames - 1) * each.step;
          if (there + slack > start || last_there + slack > last_start)
            say("precedence: {} starts on {} at {} ps, before it can", stream.name, each.link->name, start);
          if ((problem_.model.no_wait || (!is_held_ && margin_ > 0)) && start != there)
            say("no-wait: {} waits for {}", stream.name, each.link->name);
        }
        each.there.push_back(there);
        if (std::find(stream.listeners.begin(), stream.listeners.end(), each.link->to) == stream.listeners.end())
          continue;
        const Ps arrival = start + each.block + each.link->propagation + each.link->forwarding;
        if (stream.deadline && arrival > *stream.deadline + turn)
          say("deadline: {} is at {} {} ps too late", stream.name, problem_.nodes[each.link->to].name,
              arrival - *stream.deadline - turn);
        if (stream.latency && arrival - *begin > *stream.latency)
          say("latency: {} takes {} ps to {}, not {} ps", stream.name, arrival - *begin,
              problem_.nodes[each.link->to].name, *stream.latency);
        auto [place, is_new] = arrivals.try_emplace(each.link->to, arrival - turn, arrival - turn);
        place->second = {std::min(place->second.first, arrival - turn), std::max(place->second.second, arrival - turn)};
      }
    }
    for (const auto& [node, range] : arrivals)
      if (stream.jitter && range.second - range.first > *stream.jitter)
        say("jitter: {} varies at {} by {} ps, not {} ps", stream.name, problem_.nodes[node].name,
            range.second - range.first, *stream.jitter);
  }

  /// After how long all streams have begun together again.
  std::optional<Ps> common() {
    if (!asked_common_) {
      asked_common_ = true;
      int128 all = 1;
      for (const Stream& each : problem_.streams) {
        all *= each.period / std::gcd(static_cast<Ps>(all), each.period);
        if (all > schedule::longest_time) return common_;
      }
      common_ = static_cast<Ps>(all);
    }
    return common_;
  }

  void judge_link(schedule::LinkIndex l, const std::vector<const OnLink*>& passages) {
    const Link& link = problem_.links[l];
    const Ps gap = problem_.model.gap * link.octet + (is_held_ ? 0 : 2 * margin_);
    // What repeats strictly repeats here after the common multiple of these streams' periods.
    int128 span = 1;
    bool listed = false;
    for (const OnLink* each : passages) {
      if (span <= schedule::longest_time)
        span *= each->stream->period / std::gcd(static_cast<Ps>(span), each->stream->period);
      if (each->starts.size() > 1) listed = true;
    }
    if (listed) span = *common();
    Ps count = 0;
    for (const OnLink* each : passages)
      if (span <= schedule::longest_time) count += static_cast<Ps>(span) / each->stream->period;
    if (span > schedule::longest_time || count > most_turns) return judge_pairs(link, passages, gap);
    const Ps whole = static_cast<Ps>(span);
    std::vector<Turn> turns;
    for (const OnLink* each : passages) {
      const Ps period = each->stream->period;
      const bool one = each->starts.size() == 1;
      for (Ps k = 0; k < whole / period; ++k) {
        const Ps start = one ? each->starts[0] + k * period : each->starts[static_cast<std::size_t>(k)];
        const Ps wait = one ? each->starts[0] - each->there[0] : start - each->there[static_cast<std::size_t>(k)];
        const Ps at = (start % whole + whole) % whole;
        turns.push_back({at, at - wait, each});
      }
    }
    std::sort(turns.begin(), turns.end(), [](const Turn& a, const Turn& b) { return a.start < b.start; });
    for (std::size_t i = 0; i < turns.size(); ++i) {
      const Turn& a = turns[i];
      const Turn& b = turns[(i + 1) % turns.size()];
      const Ps next = b.start + (i + 1 == turns.size() ? whole : 0);
      if (a.start + a.passage->block + gap > next)
        say("overlap: {} and {} on {} at {} ps", a.passage->stream->name, b.passage->stream->name, link.name,
            next % whole);
    }
    for (int c = 0; c < 8; ++c) judge_queue(link, turns, c, whole);
    if (!solution_.gates.empty()) judge_gates(l, turns, whole);
  }

  /// What one queue sends must have come in that order, and surely: nothing at one instant, nor within the margin if it
  /// came over different links.
  void judge_queue(const Link& link, const std::vector<Turn>& turns, int traffic_class, Ps whole) {
    std::vector<const Turn*> queue;
    for (const Turn& each : turns)
      if (each.passage->traffic_class == traffic_class) queue.push_back(&each);
    for (std::size_t i = 0; queue.size() > 1 && i < queue.size(); ++i) {
      const Turn& a = *queue[i];
      const Turn& b = *queue[(i + 1) % queue.size()];
      const Ps b_there = b.there + (i + 1 == queue.size() ? whole : 0);
      const Ps a_last = a.there + (a.passage->stream->frames - 1) * a.passage->comes_every;
      const Link* const a_from = link_before(*a.passage);
      const Link* const b_from = link_before(*b.passage);
      const Ps apart = is_held_ && a_from != b_from ? margin_ : 0;
      if (b_there <= a_last + apart)
        say("order: {} is sent behind {} on {}, but does not surely come behind it", b.passage->stream->name,
            a.passage->stream->name, link.name);
    }
  }

  const Link* link_before(const OnLink& passage) const {
    if (passage.before < 0) return nullptr;
    const auto s = static_cast<std::size_t>(passage.stream - problem_.streams.data());
    return &problem_.links[solution_.streams[s]->route[static_cast<std::size_t>(passage.before)]];
  }

  void judge_pairs(const Link& link, const std::vector<const OnLink*>& passages, Ps gap) {
    for (std::size_t i = 0; i < passages.size(); ++i) {
      const OnLink& a = *passages[i];
      if (a.starts.size() != 1)
        return say("start: {} cannot be compared on {}: everything repeats after too long a time", a.stream->name,
                   link.name);
      if (a.block + gap > a.stream->period)
        say("overlap: {} meets its next repetition on {}", a.stream->name, link.name);
      for (std::size_t j = 0; j < i; ++j) {
        const OnLink& b = *passages[j];
        const Ps every = std::gcd(a.stream->period, b.stream->period);
        const Ps apart = ((b.starts[0] - a.starts[0]) % every + every) % every;
        if (apart < a.block + gap || every - apart < b.block + gap)
          say("overlap: {} and {} on {}", a.stream->name, b.stream->name, link.name);
      }
    }
  }

  void judge_gates(schedule::LinkIndex l, const std::vector<Turn>& turns, Ps whole) {
    const Link& link = problem_.links[l];
    const auto found = solution_.gates.find(l);
    if (found == solution_.gates.end() || found->second.entries.empty())
      return say("gate-list: {} has none", link.name);
    const schedule::GateList& list = found->second;
    if (list.entries.size() > link.entries)
      say("gate-entries: {} has {}, and takes {}", link.name, list.entries.size(), link.entries);
    Ps sum = 0;
    for (const auto& entry : list.entries) {
      if (entry.interval < problem_.model.tick || entry.interval % problem_.model.tick != 0)
        return say("gate-list: {} has an entry of {} ps", link.name, entry.interval);
      sum += entry.interval;
    }
    if (sum != list.cycle || list.cycle % whole != 0)
      return say("gate-list: the cycle of {} is {} ps, its entries are {} ps, everything repeats after {} ps",
                 link.name, list.cycle, sum, whole);
    unsigned scheduled = 0;
    for (const Turn& each : turns) scheduled |= 1u << each.passage->traffic_class;
    const Ps guard = std::max(problem_.model.gap * link.octet, problem_.model.guard_octets * link.octet);
    const Ps wide = is_held_ ? 0 : margin_;
    // Which gates are open from an instant on; asked at the begin and at each edge within.
    std::vector<Ps> edges;
    for (Ps at = 0; const auto& entry : list.entries) edges.push_back(at), at += entry.interval;
    const auto all_of = [&](Ps from, Ps until, auto good) {
      while (from < until) {
        const Ps phase = (from % list.cycle + list.cycle) % list.cycle;
        const auto index =
            static_cast<std::size_t>(std::upper_bound(edges.begin(), edges.end(), phase) - edges.begin()) - 1;
        if (!good(list.entries[index].open)) return false;
        from += edges[index] + list.entries[index].interval - phase;
      }
      return true;
    };
    for (Ps turn = 0; turn < list.cycle; turn += whole)
      for (const Turn& each : turns) {
        const Ps before = each.passage->before >= 0 ? wide : 0;
        const unsigned mine = 1u << each.passage->traffic_class;
        const Ps from = each.start + turn - before, until = each.start + turn + each.passage->block + wide;
        if (!all_of(from, until, [&](unsigned open) { return (open & mine) != 0; }))
          say("gate-closed: class {} of {} while {} passes at {} ps", each.passage->traffic_class, link.name,
              each.passage->stream->name, each.start + turn);
        if (!all_of(from, until, [&](unsigned open) { return (open & ~mine) == 0; }))
          say("gate-other: another class of {} is open while {} passes at {} ps", link.name, each.passage->stream->name,
              each.start + turn);
        if (!all_of(from - guard, from, [&](unsigned open) { return (open & ~scheduled) == 0; }))
          say("gate-other: another class of {} is open right before {} passes at {} ps", link.name,
              each.passage->stream->name, each.start + turn);
      }
  }

  const Problem& problem_;
  const Solution& solution_;
  std::size_t most_;
  Ps margin_ = 0;
  bool is_held_ = true;
  bool asked_common_ = false;
  std::optional<Ps> common_;
  std::vector<std::vector<OnLink>> passages_;
  std::vector<std::string> wrong_;
};

}  // namespace

std::vector<std::string> check(const Problem& problem, const Solution& solution, std::size_t most) {
  return Judge(problem, solution, most).run();
}

}  // namespace takt::schedule_check
