// SPDX-License-Identifier: Apache-2.0
#include "schedule/way.hpp"

namespace takt::schedule {

std::optional<Way> make_way(const Timing& timing, const Stream& stream, std::span<const LinkIndex> links) {
  const Problem& problem = timing.problem();
  const bool flows = problem.model.no_wait || timing.kind() == GateTiming::flowing;
  Way way;
  way.links.assign(links.begin(), links.end());
  way.parents.reserve(links.size());
  way.lags.reserve(links.size());
  way.occupied.reserve(links.size());
  std::size_t listeners = 0;
  for (std::size_t i = 0; i < links.size(); ++i) {
    const Link& link = problem.links[links[i]];
    std::int32_t parent = -1;
    if (link.from != stream.talker) {
      for (std::size_t j = 0; j < i && parent < 0; ++j)
        if (problem.links[links[j]].to == link.from) parent = static_cast<std::int32_t>(j);
      if (parent < 0 || !problem.nodes[link.from].is_bridge) return std::nullopt;
    }
    if (link.to == stream.talker) return std::nullopt;
    for (std::size_t j = 0; j < i; ++j)
      if (problem.links[links[j]].to == link.to) return std::nullopt;
    way.parents.push_back(parent);
    Ps lag = 0;
    if (parent >= 0) {
      const Link& before = problem.links[links[static_cast<std::size_t>(parent)]];
      if (timing.train_delay(stream, before, link) > 0) {
        if (flows) return std::nullopt;
        way.delays_trains = true;
      }
      lag = way.lags[static_cast<std::size_t>(parent)] + timing.lag(stream, before, link);
    }
    way.lags.push_back(lag);
    way.occupied.push_back(timing.occupied(stream, link));
    if (way.occupied.back() > stream.period) return std::nullopt;
    if (std::find(stream.listeners.begin(), stream.listeners.end(), link.to) != stream.listeners.end()) {
      ++listeners;
      way.arrival = std::max(way.arrival, lag + timing.to_listener(stream, link));
    } else {
      bool goes_on = false;
      for (std::size_t j = i + 1; j < links.size() && !goes_on; ++j) goes_on = problem.links[links[j]].from == link.to;
      if (!goes_on) return std::nullopt;
    }
  }
  way.tails.assign(links.size(), 0);
  for (std::size_t i = links.size(); i-- > 0;) {
    const Link& link = problem.links[links[i]];
    if (!problem.nodes[link.to].is_bridge ||
        std::find(stream.listeners.begin(), stream.listeners.end(), link.to) != stream.listeners.end())
      way.tails[i] = std::max(way.tails[i], timing.to_listener(stream, link));
    if (way.parents[i] < 0) continue;
    const auto parent = static_cast<std::size_t>(way.parents[i]);
    way.tails[parent] = std::max(way.tails[parent], way.lags[i] - way.lags[parent] + way.tails[i]);
  }
  if (listeners != stream.listeners.size() || (stream.latency && way.arrival > *stream.latency)) return std::nullopt;
  return way;
}

StartWindow start_window(const Stream& stream, const Way& way) {
  StartWindow window{stream.release, stream.release + stream.period - 1};
  if (stream.deadline) window.last = std::min(window.last, *stream.deadline - way.arrival);
  return window;
}

}  // namespace takt::schedule
