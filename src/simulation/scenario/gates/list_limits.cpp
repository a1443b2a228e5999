// SPDX-License-Identifier: Apache-2.0
#include "scenario/gates/list_limits.hpp"

#include <algorithm>
#include <vector>

namespace takt::scenario {
namespace {

using Obstacle = ListObstacle;

/// A stretch of the cycle in which the other classes are closed; those of a cycle stand in order and do not touch.
struct Closed {
  std::int64_t begin = 0, end = 0;
  models::GateStates open = 0;
};

class Fitting {
 public:
  Fitting(const GateList& list, models::GateStates scheduled, const ListLimits& limits)
      : cycle_(list.cycle.ps()),
        least_(limits.least_interval.ps()),
        granule_(limits.granularity.ps()),
        others_(static_cast<models::GateStates>(~scheduled)) {
    least_ = (least_ + granule_ - 1) / granule_ * granule_;
    std::int64_t at = 0;
    for (const GateList::Entry& entry : list.entries) {
      const std::int64_t end = at + entry.interval.ps();
      if ((entry.open & others_) != others_)
        closed_.push_back(
            {at / granule_ * granule_, std::min(cycle_, (end + granule_ - 1) / granule_ * granule_), entry.open});
      at = end;
    }
    was_always_closed_ = closed_.size() == list.entries.size();
    join();
  }

  void lengthen() {
    for (std::size_t before = closed_.size() + 1; closed_.size() < before;) {
      before = closed_.size();
      for (Closed& each : closed_) {
        each.end = std::min(cycle_, std::max(each.end, each.begin + least_));
        each.begin = std::max<std::int64_t>(0, std::min(each.begin, each.end - least_));
      }
      join();
    }
  }

  bool is_without_time() const {
    return !was_always_closed_ && closed_.size() == 1 && closed_.front().begin == 0 && closed_.front().end == cycle_;
  }

  std::size_t entries() const {
    if (closed_.empty()) return 1;
    return 2 * closed_.size() + 1 - (closed_.front().begin == 0 ? 1 : 0) - (closed_.back().end == cycle_ ? 1 : 0);
  }

  /// Gives up the shortest times of the others, for each entry that this saves, until so many entries do; never the
  /// last one.
  void give_up(std::size_t most) {
    struct Gap {
      std::size_t before = 0;  ///< stretches in front of it
      std::int64_t price = 0;
    };
    std::vector<Gap> gaps;
    for (std::size_t i = 0; i <= closed_.size(); ++i) {
      const std::int64_t from = i == 0 ? 0 : closed_[i - 1].end,
                         until = i == closed_.size() ? cycle_ : closed_[i].begin;
      const bool is_at_edge = i == 0 || i == closed_.size();  // saves one entry, not two
      if (from < until) gaps.push_back({i, is_at_edge ? 2 * (until - from) : until - from});
    }
    if (gaps.empty()) return;
    std::stable_sort(gaps.begin(), gaps.end(), [](const Gap& a, const Gap& b) { return a.price < b.price; });
    const std::size_t stretches = closed_.size();
    std::size_t left = entries();
    for (std::size_t g = 0; g + 1 < gaps.size() && left > most; ++g) {
      const std::size_t i = gaps[g].before;
      left -= i == 0 || i == stretches ? 1 : 2;
      if (i == 0)
        closed_.front().begin = 0;
      else
        closed_[i - 1].end = i == stretches ? cycle_ : closed_[i].begin;
    }
    join();
  }

  GateList list() const {
    GateList made;
    made.cycle = sim::Duration::from_ps(cycle_);
    std::int64_t at = 0;
    const auto add = [&](std::int64_t until, models::GateStates open) {
      if (until > at) made.entries.push_back({open, sim::Duration::from_ps(until - at)});
      at = until;
    };
    for (const Closed& each : closed_) {
      add(each.begin, others_);
      add(each.end, each.open);
    }
    add(cycle_, others_);
    return made;
  }

 private:
  /// Stretches that touch, overlap, or leave the others less than an entry become one.
  void join() {
    std::vector<Closed> kept;
    for (const Closed& each : closed_)
      if (!kept.empty() && each.begin - kept.back().end < std::max<std::int64_t>(least_, 1)) {
        kept.back().end = std::max(kept.back().end, each.end);
        kept.back().open = static_cast<models::GateStates>(kept.back().open | each.open);
      } else {
        kept.push_back(each);
      }
    if (!kept.empty() && kept.front().begin < least_) kept.front().begin = 0;
    if (!kept.empty() && cycle_ - kept.back().end < least_) kept.back().end = cycle_;
    closed_ = std::move(kept);
  }

  std::int64_t cycle_, least_, granule_;
  models::GateStates others_;
  bool was_always_closed_ = false;
  std::vector<Closed> closed_;
};

}  // namespace

bool keeps_to(const GateList& list, const ListLimits& limits) {
  const auto fits = [&](const GateList::Entry& entry) {
    return entry.interval >= limits.least_interval && entry.interval % limits.granularity == sim::Duration();
  };
  return list.entries.size() <= limits.entries && list.cycle % limits.granularity == sim::Duration() &&
         std::all_of(list.entries.begin(), list.entries.end(), fits);
}

FittedList fit_list(const GateList& list, models::GateStates scheduled, bool has_waiting, const ListLimits& limits) {
  if (keeps_to(list, limits)) return {Obstacle::none, list, 0};
  if (list.cycle % limits.granularity != sim::Duration()) return {Obstacle::cycle, {}, 0};
  if (has_waiting)
    return {list.entries.size() > limits.entries ? Obstacle::entries : Obstacle::waiting, {}, list.entries.size()};
  Fitting fitting(list, scheduled, limits);
  fitting.lengthen();
  if (!fitting.is_without_time()) fitting.give_up(limits.entries);
  if (fitting.is_without_time() || list.cycle < limits.least_interval) return {Obstacle::no_time, {}, 0};
  if (fitting.entries() > limits.entries) return {Obstacle::entries, {}, fitting.entries()};
  return {Obstacle::none, fitting.list(), 0};
}

}  // namespace takt::scenario
