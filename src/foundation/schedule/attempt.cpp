// SPDX-License-Identifier: Apache-2.0
#include "schedule/attempt.hpp"

#include <algorithm>
#include <numeric>

#include "schedule/fit.hpp"

namespace takt::schedule {
namespace {

Ps phase(Ps at, Ps period) {
  if (at >= 0 && at < period) return at;  // mostly, and a division takes long
  const Ps rest = at % period;
  return rest < 0 ? rest + period : rest;
}

/// Of a stream that stays: more than all others together can come to.
constexpr std::uint64_t priceless = std::uint64_t{1} << 40;

GateTiming timing_of(const Problem& problem) {
  return problem.model.no_wait && problem.model.margin > 0 ? GateTiming::flowing : GateTiming::held;
}

}  // namespace

Ground::Ground(const Problem& problem, const SearchOptions& options)
    : options_(options),
      timing_(problem, timing_of(problem)),
      periods_(problem),
      routes_(timing_),
      asked_(problem.streams.size()),
      ways_(problem.streams.size()) {
  first_.reserve(problem.streams.size());
  for (StreamIndex s = 0; s < problem.streams.size(); ++s) first_.push_back(routes_.first(s));
}

Ground::Ground(const Problem& problem, const SearchOptions& options, std::vector<Way> ways,
               std::vector<std::optional<Ps>> fixed)
    : options_(options),
      timing_(problem, GateTiming::held),
      periods_(problem),
      routes_(timing_),
      fixed_(std::move(fixed)),
      asked_(problem.streams.size()),
      ways_(problem.streams.size()) {
  for (Way& way : ways) {
    ways_[first_.size()] = {way};
    first_.push_back(std::move(way));
  }
}

const std::vector<Way>& Ground::ways(StreamIndex stream) const {
  std::call_once(asked_[stream], [&] {
    if (!first_[stream] || !ways_[stream].empty()) return;
    const std::size_t most = options_.routes == RouteChoice::search ? options_.most_ways : 1;
    sim::RandomStream random(options_.seed, problem().streams[stream].name, "ways");
    ways_[stream] = routes_.several(stream, *first_[stream], most, random);
  });
  return ways_[stream];
}

Attempt::Attempt(const Ground& ground, std::uint32_t number)
    : ground_(ground),
      number_(number),
      random_(ground.options().seed, "attempt " + std::to_string(number), "order"),
      board_(ground.periods(), ground.problem().links.size()),
      stands_(ground.problem().streams.size()),
      price_(ground.problem().streams.size(), 1),
      covers_(ground.problem().streams.size()),
      last_span_(ground.problem().streams.size()) {
  waits_ = number >= 2 && number % 3 != 1 && !ground.problem().model.no_wait;
}

/// Those first that are hard to place: short periods, then much to send on many links, then little time to spare. Later
/// attempts shuffle more and more.
std::vector<StreamIndex> Attempt::order() {
  const Problem& problem = ground_.problem();
  std::vector<StreamIndex> streams(problem.streams.size());
  std::iota(streams.begin(), streams.end(), 0u);
  struct Key {
    Ps period;
    double weight;
  };
  std::vector<Key> keys(streams.size());
  const bool knows_hardness = !ground_.options().hardness.empty() && number_ % 2 == 0;
  for (const StreamIndex s : streams) {
    const Stream& stream = problem.streams[s];
    double work = 0;
    if (const auto& way = ground_.first(s))
      work = static_cast<double>(std::accumulate(way->occupied.begin(), way->occupied.end(), Ps{0}));
    const Ps slack = stream.deadline && ground_.first(s) ? start_window(stream, *ground_.first(s)).last : stream.period;
    const double noise = number_ < 2 ? 1.0 : 1.0 + random_.unit() * std::min(4u, number_) / 2;
    if (knows_hardness) {
      // What was in the way most often before comes first.
      keys[s] = {0, static_cast<double>(ground_.options().hardness[s]) * noise};
      continue;
    }
    keys[s] = {number_ % 4 == 3 ? 0 : std::min(stream.period, number_ % 2 == 0 ? stream.period : slack), work * noise};
  }
  std::stable_sort(streams.begin(), streams.end(), [&](StreamIndex a, StreamIndex b) {
    return keys[a].period != keys[b].period ? keys[a].period < keys[b].period : keys[a].weight > keys[b].weight;
  });
  return streams;
}

void Attempt::put(StreamIndex stream, Stand stand) {
  const std::uint32_t period = ground_.periods().of(stream);
  const Way& way = *stand.way;
  for (std::size_t hop = 0; hop < way.links.size(); ++hop)
    board_.add(way.links[hop], period, stand.start(hop), way.occupied[hop], stream);
  stands_[stream] = std::move(stand);
  ++placed_;
}

void Attempt::remove_stream(StreamIndex stream) {
  const Stand& stand = stands_[stream];
  const std::uint32_t period = ground_.periods().of(stream);
  for (std::size_t hop = 0; hop < stand.way->links.size(); ++hop)
    board_.remove(stand.way->links[hop], period, stand.start(hop), stream);
  stands_[stream] = {};
  --placed_;
}

bool Attempt::place_free(StreamIndex stream, bool at_random) {
  ++steps_;
  const auto try_way = [&](const Way& way) {
    const StartWindow window = start_window(ground_.problem().streams[stream], way);
    if (window.is_empty()) return false;
    std::optional<Ps> at;
    if (at_random) {
      const Ps from =
          window.first + static_cast<Ps>(random_.below(static_cast<std::uint64_t>(window.last - window.first) + 1));
      at = first_fit(board_, ground_.periods(), ground_.periods().of(stream), way, from, window.last);
      if (!at) at = first_fit(board_, ground_.periods(), ground_.periods().of(stream), way, window.first, from);
    } else {
      at = first_fit(board_, ground_.periods(), ground_.periods().of(stream), way, window.first, window.last);
    }
    if (at) put(stream, {&way, *at, {}});
    return at.has_value();
  };
  if (!at_random) {
    if (ground_.first(stream) && try_way(*ground_.first(stream))) return true;
  }
  const auto& ways = ground_.ways(stream);
  if (ways.empty()) return false;
  const std::size_t start = at_random ? random_.below(ways.size()) : 1;
  for (std::size_t i = at_random ? 0 : 1; i < ways.size(); ++i)
    if (try_way(ways[(start + i - (at_random ? 0 : 1)) % ways.size()])) return true;
  return false;
}

bool Attempt::place_all_once() {
  for (const StreamIndex s : order()) place_free(s, false);
  remember_best();
  const bool in_order = assign_classes();
  return in_order && placed_ == stands_.size();
}

/// Whether a place is cheaper than the best so far, or drawn from those that cost as much.
bool Attempt::is_as_cheap(std::uint64_t cost, const Spot& best) {
  if (cost > best.cost) return false;
  if (cost < best.cost) ties_ = 0;
  ++ties_;
  return cost < best.cost || random_.below(ties_) == 0;
}

/// Goes over all starts on a way and keeps the cheapest: the sum of what those cost who would be met. Only where
/// somebody's claim ends a start can be cheaper than just before.
void Attempt::look_for_cheaper(StreamIndex stream, const Way& way, Spot& best) {
  const StartWindow window = start_window(ground_.problem().streams[stream], way);
  if (window.is_empty()) return;
  const std::uint32_t period = ground_.periods().of(stream);
  // What a stream forbids on one link and on the next mostly overlaps: that is one span, and copies are made of it only
  // once.
  spans_.clear();
  for (std::size_t hop = 0; hop < way.links.size(); ++hop) {
    const Ps lag = way.lags[hop];
    board_.for_blocked(way.links[hop], period, way.occupied[hop], [&](StreamIndex other, Ps begin, Ps end, Ps every) {
      Span span{begin + 1 - lag, end - lag, every, other};
      std::uint32_t& last = last_span_[other];
      if (last != 0) {
        Span& before = spans_[last - 1];
        const Ps length = span.until - span.from;
        span.from = before.from + phase(span.from - before.from, every);
        if (span.from - before.from > every / 2) span.from -= every;
        span.until = span.from + length;
        if (span.from <= before.until && span.until >= before.from) {
          before.from = std::min(before.from, span.from);
          before.until = std::max(before.until, span.until);
          return;
        }
      }
      spans_.push_back(span);
      last = static_cast<std::uint32_t>(spans_.size());
    });
  }
  edges_.clear();
  for (const Span& span : spans_) {
    last_span_[span.other] = 0;
    const Ps blocked = span.until - span.from;
    if (blocked >= span.every || window.last - window.first > span.every * most_places) {
      edges_.push_back({window.first, span.other, 1});
      continue;
    }
    for (Ps at = window.first - span.every + phase(span.from - window.first, span.every); at <= window.last;
         at += span.every) {
      const Ps until = at + blocked;
      if (until <= window.first) continue;
      edges_.push_back({std::max(at, window.first), span.other, 1});
      if (until <= window.last) edges_.push_back({until, span.other, -1});
    }
  }
  std::sort(edges_.begin(), edges_.end(), [](const Edge& a, const Edge& b) { return a.at < b.at; });
  std::uint64_t cost = 0;
  Ps here = window.first;
  const auto offer = [&] {
    if (!is_as_cheap(cost, best)) return;
    best.stand.way = &way;
    best.stand.at = here;
    best.stand.starts.clear();
    best.cost = cost;
  };
  for (std::size_t i = 0; i < edges_.size();) {
    if (edges_[i].at != here) {
      offer();
      here = edges_[i].at;
    }
    for (; i < edges_.size() && edges_[i].at == here; ++i) {
      std::uint32_t& covers = covers_[edges_[i].stream];
      if (edges_[i].change > 0) {
        if (covers++ == 0) cost += price_[edges_[i].stream];
      } else if (--covers == 0) {
        cost -= price_[edges_[i].stream];
      }
    }
  }
  offer();
  for (const Edge& edge : edges_) covers_[edge.stream] = 0;
}

void Attempt::find_conflicts(StreamIndex stream, const Stand& stand, std::vector<StreamIndex>& found) const {
  const std::uint32_t period = ground_.periods().of(stream);
  const Way& way = *stand.way;
  for (std::size_t hop = 0; hop < way.links.size(); ++hop)
    board_.for_blocked(way.links[hop], period, way.occupied[hop], [&](StreamIndex other, Ps begin, Ps end, Ps every) {
      const Ps blocked = end - begin - 1;
      if (blocked >= every || phase(stand.start(hop) - begin - 1, every) < blocked) found.push_back(other);
    });
  std::sort(found.begin(), found.end());
  found.erase(std::unique(found.begin(), found.end()), found.end());
}

Attempt::Spot Attempt::cheapest(StreamIndex stream) {
  Spot best;
  ties_ = 0;
  const auto& ways = ground_.ways(stream);
  // A few of many ways at a time: the others have their turn when the stream comes again.
  constexpr std::size_t at_a_time = 6;
  const std::size_t start = ways.size() > at_a_time ? random_.below(ways.size()) : 0;
  for (std::size_t i = 0; i < std::min(ways.size(), at_a_time); ++i) {
    const Way& way = ways[(start + i) % ways.size()];
    look_for_cheaper(stream, way, best);
    const auto& latency = ground_.problem().streams[stream].latency;
    if (waits_ && best.cost > 0 && !(latency && *latency <= way.arrival)) look_for_cheaper_waiting(stream, way, best);
  }
  return best;
}

/// Moves somebody elsewhere, so that what comes next finds other gaps.
void Attempt::perturb() {
  const auto stream = static_cast<StreamIndex>(random_.below(stands_.size()));
  if (stands_[stream].way == nullptr || price_[stream] >= priceless) return;
  const Stand before = stands_[stream];
  remove_stream(stream);
  if (!place_free(stream, true)) put(stream, before);
}

void Attempt::remember_best() {
  if (placed_ < best_count_ || placed_ == 0) return;
  best_count_ = placed_;
  best_ = stands_;
}

bool Attempt::run(std::uint64_t most_steps, const Stop& stop) {
  std::vector<StreamIndex> waiting;
  for (StreamIndex s = 0; s < stands_.size(); ++s) {
    if (!ground_.fixed(s)) continue;
    put(s, {&*ground_.first(s), *ground_.fixed(s), {}});
    price_[s] = priceless;
  }
  for (const StreamIndex s : order()) {
    if (ground_.fixed(s)) continue;
    if (!place_free(s, number_ % 4 == 2)) waiting.push_back(s);
    if ((steps_ & 63) == 0 && stop()) return false;
  }
  remember_best();
  std::reverse(waiting.begin(), waiting.end());
  std::vector<StreamIndex> met;
  std::uint64_t until = most_steps;
  for (std::uint64_t step = 0; !waiting.empty(); ++step) {
    if (step >= until || ((step & 15) == 0 && stop())) return false;
    const StreamIndex stream = waiting.back();
    waiting.pop_back();
    ++steps_;
    Spot spot = cheapest(stream);
    if (spot.stand.way == nullptr || spot.cost >= priceless) return false;
    met.clear();
    if (spot.cost > 0) find_conflicts(stream, spot.stand, met);
    for (const StreamIndex other : met) {
      remove_stream(other);
      price_[other] += 1;
    }
    put(stream, std::move(spot.stand));
    for (const StreamIndex other : met) waiting.push_back(other);
    if (placed_ > best_count_) {
      remember_best();
      until = step + most_steps;  // it gets on
    }
    if (!waiting.empty()) {
      if (met.size() > 1) std::swap(waiting[waiting.size() - 1 - random_.below(met.size())], waiting.back());
      perturb();
    }
  }
  remember_best();
  return assign_classes();
}

std::vector<LeftOver> Attempt::left_over() {
  std::vector<LeftOver> all;
  for (StreamIndex s = 0; s < stands_.size(); ++s)
    if (best_.empty() || best_[s].way == nullptr) all.push_back({s, {}});
  if (all.empty() || best_.empty()) return all;
  // Who is in the way is said of the schedule that is handed out.
  for (StreamIndex s = 0; s < stands_.size(); ++s)
    if (stands_[s].way != nullptr) remove_stream(s);
  for (StreamIndex s = 0; s < stands_.size(); ++s)
    if (best_[s].way != nullptr) put(s, best_[s]);
  std::fill(price_.begin(), price_.end(), 1);
  constexpr std::size_t most = 100;
  for (std::size_t i = 0; i < std::min(all.size(), most); ++i) {
    const Spot spot = cheapest(all[i].stream);
    if (spot.stand.way != nullptr) find_conflicts(all[i].stream, spot.stand, all[i].in_the_way);
  }
  return all;
}

Solution Attempt::solution() const {
  Solution solution;
  solution.timing = ground_.timing().kind();
  solution.streams.resize(stands_.size());
  for (StreamIndex s = 0; s < best_.size(); ++s) {
    const Stand& stand = best_[s];
    if (stand.way == nullptr) continue;
    Placement placement;
    placement.route = stand.way->links;
    for (std::size_t hop = 0; hop < stand.way->links.size(); ++hop) placement.starts.push_back({stand.start(hop)});
    placement.classes.assign(placement.route.size(), ground_.problem().streams[s].traffic_class);
    if (!classes_.empty()) placement.classes = classes_[s];
    solution.streams[s] = std::move(placement);
  }
  return solution;
}

}  // namespace takt::schedule
