// SPDX-License-Identifier: Apache-2.0
#include "analysis/frame_sequence.hpp"

#include <algorithm>
#include <numeric>
#include <tuple>

namespace takt::analysis {
namespace {

constexpr std::size_t most_frames = 20'000;
/// Hyperperiods that are followed: frames of the second one are held against those of the third, the first and the last
/// one are there for their neighbours.
constexpr Ps rounds = 4;
constexpr int most_sequence_steps = 1'000;
/// Clusters of so many frames are looked at in every order that may be.
constexpr std::size_t most_in_any_order = 5;
constexpr Ps never_before = -unbounded_ps;

struct SequencedArrival {
  Ps earliest = 0;
  Ps latest = 0;
  std::size_t flow = 0;
  std::int64_t turn = 0;
  Ps started = 0;      // at the latest
  Ps first_start = 0;  // at the earliest
};

/// When frames may start, by the time that all clocks follow.
class Starts {
 public:
  explicit Starts(const SequenceWindows& windows) : w_(windows) {}

  /// The first instant at or after `from` by which `need` of time has passed in which a frame of `last_bit` surely may
  /// start.
  Ps certain_start(Ps from, Ps need, Ps last_bit) const {
    if (w_.is_always_open || !is_bounded(need)) return sum(from, need);
    Ps usable = 0;
    if (need > 0) {
      for (const SequenceWindows::Window& window : w_.windows)
        usable += std::max<Ps>(0, window.until - w_.error - last_bit - (window.from + window.taken + w_.error));
      if (usable == 0) return unbounded_ps;
    }
    const Ps whole = need > 0 ? (need - 1) / usable : 0;
    Ps rest = need - whole * usable;
    Ps found = unbounded_ps;
    walk(from, [&](const SequenceWindows::Window& window, Ps start_of_cycle) {
      const Ps begin = std::max(from, start_of_cycle + window.from + window.taken + w_.error);
      const Ps end = start_of_cycle + window.until - w_.error - last_bit;
      if (begin > end) return false;
      if (rest <= end - begin) {
        found = begin + rest;
        return true;
      }
      rest -= end - begin;
      return false;
    });
    return sum(found, product(w_.cycle, whole));
  }

  /// The first instant at or after `from` at which it perhaps may.
  Ps perhaps(Ps from, Ps last_bit) const {
    if (w_.is_always_open) return from;
    Ps found = from;  // if it never may, it does not matter
    walk(from - w_.error, [&](const SequenceWindows::Window& window, Ps start_of_cycle) {
      const Ps begin = std::max(from, start_of_cycle + window.from - w_.error);
      if (begin > start_of_cycle + window.until + w_.error - last_bit) return false;
      found = begin;
      return true;
    });
    return found;
  }

  /// Instants in [from, until) after which a frame of `last_bit` has just missed a window.
  std::vector<Ps> ends(Ps from, Ps until, Ps last_bit) const {
    std::vector<Ps> all;
    if (w_.is_always_open) return all;
    walk(from, [&](const SequenceWindows::Window& window, Ps start_of_cycle) {
      const Ps end = start_of_cycle + window.until - w_.error - last_bit;
      if (end >= from && end < until) all.push_back(end);
      return end >= until;
    });
    return all;
  }

 private:
  /// The windows that end at or after `from`, until `look` has found what it looks for; for two cycles and a window at
  /// most.
  template <class Look>
  void walk(Ps from, Look look) const {
    if (w_.windows.empty()) return;
    Ps into = (from - w_.base) % w_.cycle;
    if (into < 0) into += w_.cycle;
    Ps start = from - into - w_.cycle;  // a window may reach over the end of the cycle in which it began
    const auto first =
        std::lower_bound(w_.windows.begin(), w_.windows.end(), into + w_.cycle,
                         [](const SequenceWindows::Window& window, Ps time) { return window.until < time; });
    auto i = static_cast<std::size_t>(first - w_.windows.begin());
    for (std::size_t looks = 0; looks <= 2 * w_.windows.size() + 2; ++looks, ++i) {
      while (i >= w_.windows.size()) {
        i -= w_.windows.size();
        start += w_.cycle;
      }
      if (look(w_.windows[i], start)) return;
    }
  }

  const SequenceWindows& w_;
};

class Sequence {
 public:
  Sequence(const std::vector<SequencedFlow>& flows, const SequenceWindows& windows, const OthersWork& others)
      : flows_(flows), starts_(windows), error_(windows.error), others_(others), cycle_(windows.cycle) {}

  std::optional<SequenceBound> run(std::string& reason) {
    reason = "too many frames before their times repeat";
    if (!list_arrivals()) return std::nullopt;
    find_clusters();
    reason = !is_ordered_ ? "frames may come in any order, and so miss their windows"
             : others_    ? "frames may miss their windows behind those of other classes"
             : error_ > 0 ? "frames may miss their windows, which leave too little room for clocks that are off"
                          : "frames miss their windows, or have none";
    if (has_endless_cluster()) return std::nullopt;
    bound_.is_exact = is_ordered_ && !others_;
    for (std::size_t c = 0; c < clusters_.size(); ++c)
      if (!pass(clusters_[c], end_of(c))) return std::nullopt;
    if (!repeats()) return std::nullopt;
    add_times();
    count_backlog();
    reason.clear();
    return std::move(bound_);
  }

 private:
  bool list_arrivals() {
    std::vector<Ps> periods;
    for (const SequencedFlow& flow : flows_) periods.push_back(flow.period);
    const std::optional<Ps> all = hyperperiod(periods, cycle_);
    if (!all || flows_.empty() || *all > unbounded_ps / 16) return false;
    hyperperiod_ = *all;
    std::size_t count = 0;
    for (const SequencedFlow& flow : flows_) {
      if (!is_bounded(flow.width) || flow.width > hyperperiod_ ||
          hyperperiod_ / flow.period > static_cast<Ps>(most_frames))
        return false;
      count += static_cast<std::size_t>(rounds * (hyperperiod_ / flow.period));
      if (count > most_frames) return false;
    }
    for (std::size_t f = 0; f < flows_.size(); ++f) {
      const SequencedFlow& flow = flows_[f];
      const Ps first = in_first_period(f);
      for (Ps turn = 0; turn < rounds * (hyperperiod_ / flow.period); ++turn) {
        const Ps at = first + turn * flow.period;
        arrivals_.push_back({at, at + flow.width, f, turn, 0, 0});
      }
    }
    std::sort(arrivals_.begin(), arrivals_.end(), [&](const SequencedArrival& a, const SequencedArrival& b) {
      return std::tuple(a.latest, flows_[a.flow].rank, a.flow) < std::tuple(b.latest, flows_[b.flow].rank, b.flow);
    });
    return true;
  }

  /// The first arrival, moved by whole periods; frames of one train by as many of them, so that their turns are
  /// numbered alike.
  Ps in_first_period(std::size_t f) const {
    const SequencedFlow& flow = flows_[f];
    const SequencedFlow* leader = &flow;
    if (flow.train)
      for (const SequencedFlow& other : flows_)
        if (other.train == flow.train && other.period == flow.period && other.rank < leader->rank) leader = &other;
    Ps into = leader->first % leader->period;
    if (into < 0) into += leader->period;
    return flow.first - (leader->first - into);
  }

  bool is_of_one_train(const SequencedArrival& before, const SequencedArrival& behind) const {
    const SequencedFlow& a = flows_[before.flow];
    const SequencedFlow& b = flows_[behind.flow];
    return a.train && a.train == b.train && a.period == b.period &&
           std::tuple(before.turn, a.rank) < std::tuple(behind.turn, b.rank);
  }

  /// Each cluster is a run of arrivals, by their latest instants; those of different clusters come in a certain order.
  void find_clusters() {
    for (std::size_t j = 0; j < arrivals_.size(); ++j) {
      clusters_.push_back(j);
      const auto first =
          std::lower_bound(arrivals_.begin(), arrivals_.begin() + static_cast<std::ptrdiff_t>(j), arrivals_[j].earliest,
                           [](const SequencedArrival& a, Ps time) { return a.latest < time; });
      for (auto i = static_cast<std::size_t>(first - arrivals_.begin()); i < j; ++i) {
        if (is_of_one_train(arrivals_[i], arrivals_[j])) continue;
        while (clusters_.back() > i) clusters_.pop_back();
        is_ordered_ = false;
        break;
      }
    }
  }
  std::size_t end_of(std::size_t cluster) const {
    return cluster + 1 < clusters_.size() ? clusters_[cluster + 1] : arrivals_.size();
  }
  Ps round_of(const SequencedArrival& arrival) const {
    return arrival.turn / (hyperperiod_ / flows_[arrival.flow].period);
  }

  /// A cluster that goes on over a whole hyperperiod, of which only a part is there.
  bool has_endless_cluster() const {
    for (const std::size_t c : {std::size_t{0}, clusters_.size() - 1})
      for (std::size_t i = clusters_[c]; i < end_of(c); ++i)
        if (const Ps round = round_of(arrivals_[i]); round > 0 && round + 1 < rounds) return true;
    return false;
  }

  /// `need` of the port's time after `from`, and what others take.
  Ps start(Ps from, Ps need, Ps last_bit) const {
    Ps time = 0;
    for (int step = 0; step < most_sequence_steps; ++step) {
      const Ps at = starts_.certain_start(from, others_ ? sum(need, others_(time)) : need, last_bit);
      if (!is_bounded(at)) return unbounded_ps;
      if (!others_ || at - from <= time) return at;
      time = at - from;
    }
    return unbounded_ps;
  }

  bool pass(std::size_t begin, std::size_t end) {
    Ps works = 0;
    Ps last_bit = 0;
    for (std::size_t i = begin; i < end; ++i) {
      SequencedArrival& arrival = arrivals_[i];
      works = sum(works, flows_[arrival.flow].work);
      last_bit = std::max(last_bit, flows_[arrival.flow].last_bit);
      arrival.first_start = starts_.perhaps(arrival.earliest, flows_[arrival.flow].last_bit);
    }
    if (end - begin <= most_in_any_order)
      pass_in_any_order(begin, end);
    else
      for (std::size_t i = begin; i < end; ++i)
        arrivals_[i].started =
            start(std::max(arrivals_[i].latest, before_), works - flows_[arrivals_[i].flow].work, last_bit);
    Ps done = before_;
    for (std::size_t i = begin; i < end; ++i) {
      if (!is_bounded(arrivals_[i].started)) return false;
      note_wait(arrivals_[i], end - begin == 1);
      done = std::max(done, sum(arrivals_[i].started, flows_[arrivals_[i].flow].work));
    }
    before_ = done;
    return is_bounded(done);
  }

  /// One behind the other, each as it fits. What comes first has come when what is behind it has.
  void pass_in_any_order(std::size_t begin, std::size_t end) {
    std::vector<std::size_t> order(end - begin);
    std::iota(order.begin(), order.end(), begin);
    for (std::size_t i = begin; i < end; ++i) arrivals_[i].started = 0;
    bool is_first = true;
    do {
      bool may_be = true;
      for (std::size_t a = 0; a < order.size() && may_be; ++a)
        for (std::size_t b = a + 1; b < order.size() && may_be; ++b)
          may_be = arrivals_[order[a]].earliest <= arrivals_[order[b]].latest &&
                   !is_of_one_train(arrivals_[order[b]], arrivals_[order[a]]);
      if (!may_be) continue;
      Ps before = before_;
      for (std::size_t i = 0; i < order.size(); ++i) {
        SequencedArrival& arrival = arrivals_[order[i]];
        Ps latest = arrival.latest;
        for (std::size_t behind = i + 1; behind < order.size(); ++behind)
          latest = std::min(latest, arrivals_[order[behind]].latest);
        const Ps started = start(std::max(latest, before), 0, flows_[arrival.flow].last_bit);
        arrival.started = is_first ? started : std::max(arrival.started, started);
        before = sum(started, flows_[arrival.flow].work);
      }
      is_first = false;
    } while (std::next_permutation(order.begin(), order.end()));
  }

  /// Only the frames of a round with all of its neighbours count.
  void note_wait(const SequencedArrival& arrival, bool is_alone) {
    if (bound_.flows.empty()) bound_.flows.assign(flows_.size(), {0, unbounded_ps, never_before});
    if (round_of(arrival) != rounds - 2) return;
    SequencedTimes& times = bound_.flows[arrival.flow];
    if (others_ || !is_alone) {
      times.wait = std::max(times.wait, arrival.started - arrival.earliest);
      return;
    }
    const Ps last_bit = flows_[arrival.flow].last_bit;
    // The start grows with the arrival by jumps: worst is the earliest arrival, or one that just misses a window.
    std::vector<Ps> instants{arrival.earliest};
    for (const Ps end : starts_.ends(arrival.earliest, arrival.latest, last_bit)) instants.push_back(end + 1);
    for (const Ps x : instants)
      times.wait = std::max(times.wait, starts_.certain_start(std::max(x, before_), 0, last_bit) - x);
  }

  /// What is carried over from round to round has settled.
  bool repeats() const {
    std::vector<std::vector<Ps>> starts(flows_.size());
    for (std::size_t f = 0; f < flows_.size(); ++f)
      starts[f].assign(static_cast<std::size_t>(rounds * (hyperperiod_ / flows_[f].period)), 0);
    for (const SequencedArrival& arrival : arrivals_)
      starts[arrival.flow][static_cast<std::size_t>(arrival.turn)] = arrival.started;
    for (const SequencedArrival& arrival : arrivals_)
      if (round_of(arrival) == rounds - 2 &&
          starts[arrival.flow][static_cast<std::size_t>(arrival.turn - hyperperiod_ / flows_[arrival.flow].period)] +
                  hyperperiod_ !=
              arrival.started)
        return false;
    return true;
  }

  void add_times() {
    for (const SequencedArrival& arrival : arrivals_) {
      if (round_of(arrival) != rounds - 2) continue;
      SequencedTimes& times = bound_.flows[arrival.flow];
      times.earliest = std::min(times.earliest, arrival.first_start - arrival.earliest);
      times.latest = std::max(times.latest, arrival.started - arrival.earliest);
    }
  }

  /// A frame is there from its arrival to the end of the gap behind it.
  void count_backlog() {
    std::vector<std::tuple<Ps, bool, Ps>> changes;
    for (const SequencedArrival& arrival : arrivals_) {
      const Ps work = flows_[arrival.flow].work;
      changes.emplace_back(arrival.earliest, true, work);
      changes.emplace_back(arrival.started + work, false, work);  // before what comes at that instant
    }
    std::sort(changes.begin(), changes.end());
    Ps work = 0;
    std::int64_t frames = 0;
    for (const auto& [time, comes, amount] : changes) {
      work += comes ? amount : -amount;
      frames += comes ? 1 : -1;
      bound_.backlog = std::max(bound_.backlog, work);
      bound_.backlog_frames = std::max(bound_.backlog_frames, frames);
    }
  }

  const std::vector<SequencedFlow>& flows_;
  Starts starts_;
  Ps error_;
  const OthersWork& others_;
  Ps cycle_;
  Ps hyperperiod_ = 1;
  std::vector<SequencedArrival> arrivals_;  // by latest arrival
  std::vector<std::size_t> clusters_;       // where each begins
  bool is_ordered_ = true;                  // each cluster is one frame
  Ps before_ = never_before;                // all clusters so far are done
  SequenceBound bound_;
};

}  // namespace

std::optional<SequenceBound> bound_sequence(const std::vector<SequencedFlow>& flows, const SequenceWindows& windows,
                                            const OthersWork& others, std::string& reason) {
  return Sequence(flows, windows, others).run(reason);
}

}  // namespace takt::analysis
