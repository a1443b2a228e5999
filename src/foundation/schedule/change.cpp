// SPDX-License-Identifier: Apache-2.0
#include "schedule/change.hpp"

#include <algorithm>

#include "schedule/fit.hpp"
#include "sim/check.hpp"

namespace takt::schedule {
namespace {

constexpr std::size_t most_ways = 8;
/// Places that are looked at before a stream is taken for one that fits nowhere with a single other moved.
constexpr std::size_t most_places_to_move = 2'000;

Ps phase_of(Ps at, Ps period) {
  const Ps rest = at % period;
  return rest < 0 ? rest + period : rest;
}

}  // namespace

std::string why_not_changeable(const Problem& problem, const Solution& solution) {
  const Timing timing(problem, solution.timing);
  for (StreamIndex s = 0; s < solution.streams.size(); ++s) {
    if (!solution.streams[s]) continue;
    const Placement& placement = *solution.streams[s];
    Stream unlimited = problem.streams[s];
    unlimited.latency.reset();
    const auto way = make_way(timing, unlimited, placement.route);
    if (!way || way->delays_trains) return problem.streams[s].name + " takes a way on which trains wait";
    for (std::size_t hop = 0; hop < placement.route.size(); ++hop) {
      for (std::size_t k = 0; k < placement.starts[hop].size(); ++k)
        if (placement.starts[hop][k] != placement.starts[hop][0] + static_cast<Ps>(k) * problem.streams[s].period)
          return problem.streams[s].name + " does not repeat with its period";
      if (placement.starts[hop][0] - placement.starts[0][0] != way->lags[hop])
        return problem.streams[s].name + " waits in a bridge";
    }
  }
  return {};
}

Plant::Plant(Problem problem, const Solution& solution)
    : problem_(std::move(problem)),
      timing_(problem_, solution.timing),
      periods_(problem_),
      board_(periods_, problem_.links.size()),
      routes_(timing_),
      ways_(problem_.streams.size()),
      at_(problem_.streams.size()) {
  // Room for those that come: or the first of them would wait until all others have moved.
  const std::size_t room = problem_.streams.size() + problem_.streams.size() / 4 + 64;
  problem_.streams.reserve(room);
  ways_.reserve(room);
  at_.reserve(room);
  for (StreamIndex s = 0; s < solution.streams.size(); ++s) {
    if (!solution.streams[s]) continue;
    auto way = make_way(timing_, problem_.streams[s], solution.streams[s]->route);
    TAKT_CHECK(way.has_value(), "a schedule's ways are ways");
    put(s, std::move(*way), solution.streams[s]->starts.front().front());
  }
}

void Plant::put(StreamIndex stream, Way way, Ps at) {
  for (std::size_t hop = 0; hop < way.links.size(); ++hop)
    board_.add(way.links[hop], periods_.of(stream), at + way.lags[hop], way.occupied[hop], stream);
  ways_[stream] = std::move(way);
  at_[stream] = at;
}

void Plant::remove_stream(StreamIndex stream) {
  const Way& way = *ways_[stream];
  for (std::size_t hop = 0; hop < way.links.size(); ++hop)
    board_.remove(way.links[hop], periods_.of(stream), at_[stream] + way.lags[hop], stream);
  ways_[stream].reset();
}

std::vector<Way> Plant::ways_of(StreamIndex stream) {
  const auto first = routes_.first(stream);
  if (!first) return {};
  sim::RandomStream random(1, problem_.streams[stream].name, "change");
  return routes_.several(stream, *first, most_ways, random);
}

bool Plant::place(StreamIndex stream) {
  const auto try_way = [&](const Way& way) {
    const StartWindow window = start_window(problem_.streams[stream], way);
    const auto at = window.is_empty()
                        ? std::nullopt
                        : first_fit(board_, periods_, periods_.of(stream), way, window.first, window.last);
    if (at) put(stream, way, *at);
    return at.has_value();
  };
  // The other ways cost more to find than this one to try.
  const auto first = routes_.first(stream);
  if (!first) return false;
  if (try_way(*first)) return true;
  for (const Way& way : ways_of(stream))
    if (try_way(way)) return true;
  return false;
}

/// Goes over places at which exactly one other stream is met, and moves that one if it can be anywhere else.
bool Plant::place_by_moving_one(StreamIndex stream, std::vector<StreamIndex>& moved) {
  const std::uint32_t period = periods_.of(stream);
  std::size_t looked_at = 0;
  for (const Way& way : ways_of(stream)) {
    const StartWindow window = start_window(problem_.streams[stream], way);
    if (window.is_empty()) continue;
    // Places: where the claim of somebody ends.
    std::vector<Ps> places{window.first};
    for (std::size_t hop = 0; hop < way.links.size(); ++hop)
      board_.for_blocked(way.links[hop], period, way.occupied[hop], [&](StreamIndex, Ps, Ps end, Ps every) {
        const Ps at = window.first + phase_of(end - way.lags[hop] - window.first, every);
        if (at <= window.last) places.push_back(at);
      });
    std::sort(places.begin(), places.end());
    places.erase(std::unique(places.begin(), places.end()), places.end());
    for (const Ps at : places) {
      if (++looked_at > most_places_to_move) return false;
      std::vector<StreamIndex> met;
      for (std::size_t hop = 0; hop < way.links.size() && met.size() < 2; ++hop)
        board_.for_blocked(way.links[hop], period, way.occupied[hop],
                           [&](StreamIndex other, Ps begin, Ps end, Ps every) {
                             const Ps blocked = end - begin - 1;
                             if ((blocked >= every || phase_of(at + way.lags[hop] - begin - 1, every) < blocked) &&
                                 std::find(met.begin(), met.end(), other) == met.end())
                               met.push_back(other);
                           });
      if (met.size() != 1) continue;
      const StreamIndex other = met.front();
      const Way before = *ways_[other];
      const Ps stood = at_[other];
      remove_stream(other);
      put(stream, way, at);
      if (place(other)) {
        moved.push_back(other);
        return true;
      }
      remove_stream(stream);
      put(other, before, stood);
    }
  }
  return false;
}

std::optional<Plant::Added> Plant::add(Stream stream) {
  Added added;
  added.stream = static_cast<StreamIndex>(problem_.streams.size());
  periods_.add(stream.period);
  problem_.streams.push_back(std::move(stream));
  ways_.emplace_back();
  at_.push_back(0);
  if (place(added.stream) || place_by_moving_one(added.stream, added.moved)) return added;
  problem_.streams.pop_back();
  periods_.drop_last();
  ways_.pop_back();
  at_.pop_back();
  return std::nullopt;
}

void Plant::remove(StreamIndex stream) {
  if (ways_[stream]) remove_stream(stream);
}

Plant::Rerouted Plant::fail(LinkIndex link) {
  routes_.close(link);
  Rerouted answer;
  std::vector<StreamIndex> hit;
  for (StreamIndex s = 0; s < ways_.size(); ++s)
    if (ways_[s] && std::find(ways_[s]->links.begin(), ways_[s]->links.end(), link) != ways_[s]->links.end())
      hit.push_back(s);
  for (const StreamIndex s : hit) {
    remove_stream(s);
    problem_.streams[s].route.reset();
  }
  std::stable_sort(hit.begin(), hit.end(), [&](StreamIndex a, StreamIndex b) {
    return problem_.streams[a].period < problem_.streams[b].period;
  });
  for (const StreamIndex s : hit) {
    std::vector<StreamIndex> others;
    if (!place(s) && !place_by_moving_one(s, others)) {
      answer.lost.push_back(s);
      continue;
    }
    answer.moved.push_back(s);
    answer.moved.insert(answer.moved.end(), others.begin(), others.end());
  }
  std::sort(answer.moved.begin(), answer.moved.end());
  answer.moved.erase(std::unique(answer.moved.begin(), answer.moved.end()), answer.moved.end());
  return answer;
}

Solution Plant::solution() const {
  Solution solution;
  solution.timing = timing_.kind();
  solution.streams.resize(problem_.streams.size());
  for (StreamIndex s = 0; s < ways_.size(); ++s) {
    if (!ways_[s]) continue;
    Placement placement;
    placement.route = ways_[s]->links;
    for (const Ps lag : ways_[s]->lags) placement.starts.push_back({at_[s] + lag});
    placement.classes.assign(placement.route.size(), problem_.streams[s].traffic_class);
    solution.streams[s] = std::move(placement);
  }
  return solution;
}

}  // namespace takt::schedule
