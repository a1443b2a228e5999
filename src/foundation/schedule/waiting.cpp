// SPDX-License-Identifier: Apache-2.0
// The part of an attempt that lets frames wait in bridges: each link's start may be later than the frame is there.
#include <algorithm>
#include <utility>

#include "schedule/attempt.hpp"

namespace takt::schedule {
namespace {

Ps phase(Ps at, Ps period) {
  if (at >= 0 && at < period) return at;  // mostly, and a division takes long
  const Ps rest = at % period;
  return rest < 0 ? rest + period : rest;
}

constexpr std::size_t most_labels = 5;
constexpr std::size_t most_roots = 32;

}  // namespace

/// What each start on each link of the way costs, over one period of the stream.
void Attempt::cut_into_pieces(StreamIndex stream, const Way& way) {
  const std::uint32_t index = ground_.periods().of(stream);
  const Ps period = ground_.problem().streams[stream].period;
  if (pieces_.size() < way.links.size()) pieces_.resize(way.links.size());
  for (std::size_t hop = 0; hop < way.links.size(); ++hop) {
    edges_.clear();
    board_.for_blocked(way.links[hop], index, way.occupied[hop], [&](StreamIndex other, Ps begin, Ps end, Ps every) {
      const Ps blocked = end - begin - 1;
      if (blocked >= every || period > every * most_places) {
        edges_.push_back({0, other, 1});
        return;
      }
      for (Ps at = phase(begin + 1, every); at < period; at += every) {
        edges_.push_back({at, other, 1});
        if (at + blocked < period) {
          edges_.push_back({at + blocked, other, -1});
        } else if (at + blocked > period) {
          edges_.push_back({0, other, 1});
          edges_.push_back({at + blocked - period, other, -1});
        }
      }
    });
    std::sort(edges_.begin(), edges_.end(), [](const Edge& a, const Edge& b) { return a.at < b.at; });
    auto& pieces = pieces_[hop];
    pieces.assign(1, {0, 0});
    std::uint64_t cost = 0;
    for (std::size_t i = 0; i < edges_.size();) {
      const Ps here = edges_[i].at;
      for (; i < edges_.size() && edges_[i].at == here; ++i) {
        std::uint32_t& covers = covers_[edges_[i].stream];
        if (edges_[i].change > 0) {
          if (covers++ == 0) cost += price_[edges_[i].stream];
        } else if (--covers == 0) {
          cost -= price_[edges_[i].stream];
        }
      }
      if (here == 0)
        pieces.front().cost = cost;
      else if (cost != pieces.back().cost)
        pieces.push_back({here, cost});
    }
    for (const Edge& edge : edges_) covers_[edge.stream] = 0;
  }
}

const Attempt::Piece& Attempt::piece_at(std::size_t hop, Ps at) const {
  const auto& pieces = pieces_[hop];
  return *(std::upper_bound(pieces.begin(), pieces.end(), at, [](Ps t, const Piece& piece) { return t < piece.at; }) -
           1);
}

/// From each start at the talker that may be worth it: on, link by link, at once or where it becomes cheaper. Whoever
/// is met on two links is paid for twice here; that only makes the choice less exact.
void Attempt::look_for_cheaper_waiting(StreamIndex stream, const Way& way, Spot& best) {
  const Stream& what = ground_.problem().streams[stream];
  const StartWindow window = start_window(what, way);
  if (window.is_empty()) return;
  cut_into_pieces(stream, way);
  const std::size_t hops = way.links.size();
  const Ps period = what.period;
  roots_.assign(1, window.first);
  for (std::size_t hop = 0; hop < hops; ++hop) {
    const auto& pieces = pieces_[hop];
    for (std::size_t i = 0; i < pieces.size(); ++i) {
      if (pieces[i].cost >= pieces[i == 0 ? pieces.size() - 1 : i - 1].cost) continue;
      const Ps root = window.first + phase(pieces[i].at - way.lags[hop] - window.first, period);
      if (root <= window.last) roots_.push_back(root);
    }
    // As late as it may be: the end of a free place at the talker leaves least to wait for.
    for (std::size_t i = 0; hop == 0 && i < pieces.size(); ++i) {
      if (pieces[i].cost <= pieces[i == 0 ? pieces.size() - 1 : i - 1].cost) continue;
      const Ps root = window.first + phase(pieces[i].at - 1 - window.first, period);
      if (root <= window.last) roots_.push_back(root);
    }
  }
  // Of very many some, drawn anew each time.
  if (roots_.size() > most_roots) {
    for (std::size_t i = 0; i < most_roots; ++i) std::swap(roots_[i], roots_[i + random_.below(roots_.size() - i)]);
    roots_.resize(most_roots);
  }
  std::sort(roots_.begin(), roots_.end());
  roots_.erase(std::unique(roots_.begin(), roots_.end()), roots_.end());
  if (labels_.size() < hops) labels_.resize(hops);
  for (const Ps root : roots_) {
    const Ps until = std::min(what.latency ? root + *what.latency : root + way.arrival + period,
                              what.deadline ? *what.deadline : longest_time);
    labels_[0].assign(1, {root, piece_at(0, phase(root, period)).cost, 0});
    bool reaches = labels_[0].front().cost <= best.cost;
    for (std::size_t hop = 1; hop < hops && reaches; ++hop) {
      auto& labels = labels_[hop];
      labels.clear();
      const Ps last = until - way.tails[hop];
      const std::int32_t parent = way.parents[hop];
      const Ps lag = way.lags[hop] - (parent < 0 ? 0 : way.lags[static_cast<std::size_t>(parent)]);
      for (std::uint32_t from = 0; from < labels_[hop - 1].size(); ++from) {
        const Label& before = labels_[hop - 1][from];
        Ps ready = root;
        if (parent >= 0) {
          std::uint32_t index = from;
          for (std::size_t level = hop - 1; level > static_cast<std::size_t>(parent); --level)
            index = labels_[level][index].before;
          ready = labels_[static_cast<std::size_t>(parent)][index].at + lag;
        }
        if (ready > last) continue;
        const Ps at = phase(ready, period);
        const Piece* piece = &piece_at(hop, at);
        std::uint64_t cheapest = piece->cost;
        if (before.cost + cheapest <= best.cost) labels.push_back({ready, before.cost + cheapest, from});
        if (parent < 0) continue;  // the talker sends to all its links at once
        const auto& pieces = pieces_[hop];
        auto index = static_cast<std::size_t>(piece - pieces.data());
        Ps turn = ready - at;
        for (std::size_t seen = 0; cheapest > 0 && seen < pieces.size(); ++seen) {
          if (++index == pieces.size()) index = 0, turn += period;
          const Ps start = pieces[index].at + turn;
          if (start > last) break;
          if (pieces[index].cost >= cheapest) continue;
          cheapest = pieces[index].cost;
          if (before.cost + cheapest <= best.cost) labels.push_back({start, before.cost + cheapest, from});
        }
      }
      // Who is later and no cheaper leads nowhere new.
      std::sort(labels.begin(), labels.end(),
                [](const Label& a, const Label& b) { return a.cost != b.cost ? a.cost < b.cost : a.at < b.at; });
      std::size_t kept = 0;
      for (const Label& label : labels)
        if (kept == 0 || label.at < labels[kept - 1].at) labels[kept++] = label;
      labels.resize(std::min(kept, most_labels));
      reaches = !labels.empty();
    }
    if (!reaches || !is_as_cheap(labels_[hops - 1].front().cost, best)) continue;
    best.cost = labels_[hops - 1].front().cost;
    best.stand.way = &way;
    best.stand.at = root;
    best.stand.starts.assign(hops, root);
    std::uint32_t index = 0;
    for (std::size_t hop = hops; hop-- > 0;) {
      best.stand.starts[hop] = labels_[hop][index].at;
      index = labels_[hop][index].before;
    }
  }
}

/// Frames that wait need queues such that none must overtake another in its queue. Where the classes of the streams do
/// not do, each link hands out queues of its own. False if eight are not enough: then those that found none are taken
/// out.
bool Attempt::assign_classes() {
  const Problem& problem = ground_.problem();
  const Timing& timing = ground_.timing();
  const auto waits = [](const Stand& stand) {
    return stand.way != nullptr && (!stand.starts.empty() || stand.way->delays_trains);
  };
  if (std::none_of(stands_.begin(), stands_.end(), waits)) return true;
  struct Here {
    StreamIndex stream;
    std::size_t hop;
    Ps start, wait, last;  ///< last: from the arrival of the first frame to that of the last
    std::int64_t from;     ///< link, or -1
  };
  std::vector<std::vector<Here>> by_link(problem.links.size());
  std::vector<std::vector<std::uint8_t>> classes(stands_.size());
  for (StreamIndex s = 0; s < stands_.size(); ++s) {
    const Stand& stand = stands_[s];
    if (stand.way == nullptr) continue;
    const Way& way = *stand.way;
    classes[s].assign(way.links.size(), problem.streams[s].traffic_class);
    for (std::size_t hop = 0; hop < way.links.size(); ++hop) {
      const Stream& stream = problem.streams[s];
      const std::int32_t parent = way.parents[hop];
      Here here{s, hop, stand.start(hop), 0, (stream.frames - 1) * timing.step(stream, problem.links[way.links[hop]]),
                -1};
      if (parent >= 0) {
        const Link& before = problem.links[way.links[static_cast<std::size_t>(parent)]];
        const Link& link = problem.links[way.links[hop]];
        here.from = way.links[static_cast<std::size_t>(parent)];
        here.wait = here.start - stand.start(static_cast<std::size_t>(parent)) - timing.onward(stream, before, link) +
                    timing.train_delay(stream, before, link);
        here.last = (stream.frames - 1) * timing.step(stream, before);
      }
      by_link[way.links[hop]].push_back(here);
    }
  }
  const auto clash = [&](const Here& a, const Here& b) {
    // b begins behind a by d, d + g, ...; and by so much does it come later, less what it waits longer.
    const Ps every = ground_.periods().common(ground_.periods().of(a.stream), ground_.periods().of(b.stream));
    const Ps apart = timing.kind() == GateTiming::held && a.from != b.from ? problem.model.margin : 0;
    const Ps d = phase(b.start - a.start, every);
    return d - b.wait + a.wait <= a.last + apart || every - d - a.wait + b.wait <= b.last + apart;
  };
  bool all_found = true;
  for (const auto& here : by_link) {
    // First the classes that were asked for, then the others from above.
    std::vector<std::vector<const Here*>> queues(8);
    for (const Here& each : here) {
      if (stands_[each.stream].way == nullptr) continue;
      const std::uint8_t own = problem.streams[each.stream].traffic_class;
      bool found = false;
      for (int i = 0; i < 9 && !found; ++i) {
        const auto queue = static_cast<std::uint8_t>(i == 0 ? own : 8 - i);
        if (i != 0 && queue == own) continue;
        if (std::any_of(queues[queue].begin(), queues[queue].end(),
                        [&](const Here* other) { return clash(*other, each); }))
          continue;
        queues[queue].push_back(&each);
        classes[each.stream][each.hop] = queue;
        found = true;
      }
      if (found) continue;
      all_found = false;
      remove_stream(each.stream);
      best_[each.stream] = {};
      --best_count_;
    }
  }
  classes_ = std::move(classes);
  return all_found;
}

}  // namespace takt::schedule
