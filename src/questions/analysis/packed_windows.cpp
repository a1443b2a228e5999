// SPDX-License-Identifier: Apache-2.0
#include "analysis/packed_windows.hpp"

#include <algorithm>
#include <cstdint>
#include <deque>
#include <map>
#include <tuple>

namespace takt::analysis {
namespace {

constexpr Ps slots_in_a_period = 20;  // of the shortest one
constexpr std::size_t most_places = 500;
constexpr std::size_t most_points = 200'000;
constexpr std::size_t most_looks_at_a_point = 10;  // of all; a walk that ends needs about one
constexpr Ps most_cycles_behind = 100;             // who is further behind is taken for overloaded

class PackedWalk {
 public:
  PackedWalk(const std::vector<PackedFlow>& flows, const PackedWindows& windows) : flows_(flows), w_(windows) {}

  std::optional<std::vector<Ps>> run() {
    if (flows_.empty() || w_.windows.empty() || !cut_into_slots() || !find_places()) return std::nullopt;
    if (!walk()) return std::nullopt;
    return delays_;
  }

 private:
  /// A window that frames go into, and what of it is taken. In the window in which the busy period begins, time counts
  /// from there.
  struct Place {
    std::size_t window = 0;
    bool is_first = false;
    Ps taken = 0;
    bool operator<(const Place& other) const {
      return std::tie(window, is_first, taken) < std::tie(other.window, other.is_first, other.taken);
    }
  };
  struct Step {
    std::size_t place = 0;  // where the frame goes
    Ps later = 0;           // how much later that window starts
    Ps last_bit = 0;        // after the start of its window
  };

  /// In a difference of s slots at most (s + jitter) / period + 1 frames of a flow come, both in slots: frames of slots
  /// that are s apart come less than s + 1 slots after each other.
  bool cut_into_slots() {
    Ps shortest = unbounded_ps;
    for (const PackedFlow& flow : flows_) {
      if (flow.period <= 0 || !is_bounded(flow.period) || !is_bounded(flow.jitter)) return false;
      shortest = std::min(shortest, flow.period);
    }
    slot_ = std::max<Ps>(1, shortest / slots_in_a_period);
    std::size_t stride = 1;
    for (const PackedFlow& flow : flows_) {
      const Ps period = flow.period / slot_;
      const Ps jitter = (flow.jitter + slot_ - 1) / slot_;
      if (period + jitter >= static_cast<Ps>(most_points)) return false;
      paces_.push_back({period, jitter, stride});
      stride *= static_cast<std::size_t>(period + jitter + 1);
      if (stride > most_points) return false;
    }
    moments_ = stride;
    return true;
  }

  /// Where the next frame goes that does not fit into the window any more, `later` than that one starts. Nothing if it
  /// fits nowhere.
  std::optional<Step> into_a_later(std::size_t window, Ps later, Ps work) {
    for (std::size_t looked = 0; looked < w_.windows.size(); ++looked) {
      window = (window + 1) % w_.windows.size();
      if (work - w_.gap <= w_.windows[window].room) return Step{place({window, false, work}), later, work - w_.gap};
      later = sum(later, w_.windows[window].to_next);
    }
    return std::nullopt;
  }

  std::size_t place(const Place& wanted) {
    const auto [known, is_new] = known_.try_emplace(wanted, places_.size());
    if (is_new) places_.push_back(wanted);
    return known->second;
  }

  /// All places and, by place and flow, where its next frame goes.
  bool find_places() {
    for (std::size_t w = 0; w < w_.windows.size(); ++w) place({w, true, 0});
    for (std::size_t p = 0; p < places_.size(); ++p) {
      if (places_.size() > most_places) return false;
      steps_.emplace_back();
      for (const PackedFlow& flow : flows_) {
        const Place at = places_[p];
        const PackedWindow& window = w_.windows[at.window];
        const Ps last_bit = flow.work - w_.gap;
        std::vector<Step> steps;
        if (at.taken + last_bit <= (at.is_first ? window.longest : window.room))
          steps.push_back({place({at.window, at.is_first, at.taken + flow.work}), 0,
                           (at.is_first ? w_.blocked : 0) + at.taken + last_bit});
        // A busy period may begin so late in a window that the frame does not fit.
        if (at.is_first || steps.empty()) {
          const Ps later = at.is_first ? sum(w_.blocked, std::min(at.taken + last_bit, window.longest), window.closed)
                                       : window.to_next;
          const std::optional<Step> step = into_a_later(at.window, later, flow.work);
          if (!step) return false;
          steps.push_back(*step);
        }
        steps_.back().push_back(std::move(steps));
      }
    }
    return places_.size() * moments_ <= most_points;
  }

  bool walk() {
    delays_.assign(flows_.size(), 0);
    behind_.assign(places_.size() * moments_, -unbounded_ps);
    is_due_.assign(behind_.size(), false);
    Ps cycle = 0;
    for (const PackedWindow& window : w_.windows) cycle = sum(cycle, window.to_next);
    const Ps most = product(cycle, most_cycles_behind);
    for (std::size_t w = 0; w < w_.windows.size(); ++w) reach(w, 0, 0);  // the first places, and every flow may send
    for (std::size_t looks = 0; !due_.empty(); ++looks) {
      if (looks > most_looks_at_a_point * behind_.size()) return false;
      const std::size_t point = due_.front();
      due_.pop_front();
      is_due_[point] = false;
      if (behind_[point] > most || !leave(point / moments_, point % moments_, behind_[point])) return false;
    }
    return true;
  }

  void reach(std::size_t place, std::size_t moment, Ps behind) {
    const std::size_t point = place * moments_ + moment;
    if (behind <= behind_[point]) return;
    behind_[point] = behind;
    if (is_due_[point]) return;
    is_due_[point] = true;
    due_.push_back(point);
  }

  /// `behind`: when the window starts, counted from the slot.
  bool leave(std::size_t p, std::size_t moment, Ps behind) {
    const Place& at = places_[p];
    // Who comes when all before have been sent begins a busy period.
    if (sum(behind, at.taken, at.is_first ? w_.blocked : 0) < 0) return true;
    std::size_t next_slot = 0;
    for (std::size_t f = 0; f < flows_.size(); ++f) {
      const Pace& pace = paces_[f];
      const Ps due = static_cast<Ps>(moment / pace.stride % static_cast<std::size_t>(pace.period + pace.jitter + 1));
      next_slot += static_cast<std::size_t>(std::max<Ps>(0, due - 1)) * pace.stride;
      if (due > pace.jitter) continue;
      for (const Step& step : steps_[p][f]) {
        const Ps start = sum(behind, step.later);
        delays_[f] = std::max(delays_[f], sum(start, step.last_bit));
        reach(step.place, moment + static_cast<std::size_t>(pace.period) * pace.stride, start);
      }
    }
    const bool has_begun = !at.is_first || at.taken > 0;
    if (has_begun) reach(p, next_slot, behind - slot_);
    return true;
  }

  /// In slots: how far frames are apart, and how much earlier one may come; `due` counts from 0 to the sum of both.
  struct Pace {
    Ps period = 0;
    Ps jitter = 0;
    std::size_t stride = 1;
  };

  const std::vector<PackedFlow>& flows_;
  const PackedWindows& w_;
  Ps slot_ = 1;
  std::vector<Pace> paces_;
  std::size_t moments_ = 1;  // all that may be known of when flows may send
  std::map<Place, std::size_t> known_;
  std::vector<Place> places_;
  std::vector<std::vector<std::vector<Step>>> steps_;  // by place and flow
  std::vector<Ps> behind_;                             // by point, place and moment: the furthest
  std::vector<bool> is_due_;
  std::deque<std::size_t> due_;
  std::vector<Ps> delays_;
};

}  // namespace

std::optional<std::vector<Ps>> delays_of_packed(const std::vector<PackedFlow>& flows, const PackedWindows& windows) {
  return PackedWalk(flows, windows).run();
}

}  // namespace takt::analysis
