// SPDX-License-Identifier: Apache-2.0
#include "analysis/gate_windows.hpp"

#include <algorithm>

#include "models/egress/gate_control_list.hpp"

namespace takt::analysis {

using models::TrafficClass;

GateCycle::GateCycle(const models::GateConfig& gates) {
  const models::GateControlList list(gates.admin_control_list, gates.admin_cycle_time);
  cycle_ = list.cycle_time().ps();
  base_ = gates.admin_base_time.ps();
  for (TrafficClass q = 0; q < models::traffic_class_count; ++q) {
    open_[q] = list.open_share(q).open.ps();
    if (open_[q] == cycle_) {
      windows_[q].push_back({0, cycle_});
      continue;
    }
    for (const models::GateControlList::Window& window : list.windows(q))
      if (window.from_ps >= 0 && window.from_ps < cycle_) windows_[q].push_back({window.from_ps, window.until_ps});
  }
}

bool GateCycle::is_open_at(TrafficClass q, Ps time) const {
  return std::any_of(windows_[q].begin(), windows_[q].end(), [&](const GateOpening& w) {
    return (w.from <= time && time < w.until) || (w.from <= time + cycle_ && time + cycle_ < w.until);
  });
}

/// Precondition: q is open at `time`, within the cycle.
Ps GateCycle::close_after(TrafficClass q, Ps time) const {
  if (is_always_open(q)) return unbounded_ps;
  for (const GateOpening& w : windows_[q]) {
    if (w.from <= time && time < w.until) return w.until;
    if (w.from <= time + cycle_ && time + cycle_ < w.until) return w.until - cycle_;
  }
  return time;
}

bool GateCycle::overlap(TrafficClass a, TrafficClass b) const {
  return std::any_of(windows_[a].begin(), windows_[a].end(),
                     [&](const GateOpening& w) { return is_open_at(b, w.from % cycle_); }) ||
         std::any_of(windows_[b].begin(), windows_[b].end(),
                     [&](const GateOpening& w) { return is_open_at(a, w.from % cycle_); });
}

Ps GateCycle::overhang(TrafficClass q, TrafficClass other, Ps frame, Ps gap) const {
  Ps longest = gap;
  for (const GateOpening& window : windows_[q]) {
    const Ps from = window.from % cycle_;
    if (is_open_at(other, from))
      longest = std::max(longest, std::min(frame, sum(close_after(other, from) - from, gap)));
  }
  return longest;
}

Ps GateCycle::overhang_at(std::size_t window, TrafficClass q, TrafficClass other, Ps frame, Ps gap) const {
  const Ps from = windows_[q][window].from % cycle_;
  if (other != q && is_open_at(other, from)) return std::min(frame, sum(close_after(other, from) - from, gap));
  Ps closed_for = gap;
  for (const GateOpening& before : windows_[other])
    closed_for = std::min(closed_for, ((from - before.until) % cycle_ + cycle_) % cycle_);
  return gap - closed_for;
}

PhasedSupply::PhasedSupply(const GateCycle& gates, TrafficClass q, Ps base, const std::vector<Ps>& taken_at_starts,
                           Ps error, Ps lost_at_end)
    : cycle_(gates.cycle()), base_(base) {
  const std::vector<GateOpening>& all = gates.windows(q);
  for (std::size_t w = 0; w < all.size(); ++w)
    if (const GateOpening left{all[w].from + taken_at_starts[w] + error, all[w].until - lost_at_end - error};
        left.from <= left.until) {
      windows_.push_back(left);
      usable_ += left.until - left.from;
    }
}

std::vector<Ps> PhasedSupply::ends() const {
  std::vector<Ps> all;
  for (const GateOpening& window : windows_) all.push_back(base_ + window.until);
  return all;
}

Ps PhasedSupply::time_from(Ps from, Ps need) const {
  if (windows_.empty() || !is_bounded(need) || (usable_ == 0 && need > 0)) return unbounded_ps;
  const std::int64_t whole = need > 0 ? (need - 1) / usable_ : 0;
  Ps rest = need - whole * usable_;
  Ps at = (from - base_) % cycle_;
  if (at < 0) at += cycle_;
  // A window may reach over the end of the cycle in which it began: look from the cycle before on.
  for (Ps start = -cycle_;; start += cycle_)
    for (const GateOpening& window : windows_) {
      const Ps begin = std::max(at, start + window.from);
      const Ps end = start + window.until;
      if (begin > end) continue;
      if (rest <= end - begin) return sum(begin + rest - at, product(cycle_, whole));
      rest -= end - begin;
    }
}

PeriodicSupply::PeriodicSupply(const GateCycle& gates, TrafficClass q, const std::vector<Ps>& taken_at_starts, Ps error,
                               Ps lost_at_end, std::int64_t slowest_ppt, std::int64_t fastest_ppt, Ps guard,
                               const PackedWork& packed) {
  constexpr std::int64_t one = 1'000'000'000'000;
  Ps end_of_last = -1;
  Ps first_start = 0;
  Ps more_of_last = 0;
  Ps room_of_last = -1;
  Ps packed_of_last = 0;
  const std::vector<GateOpening>& all = gates.windows(q);
  for (std::size_t w = 0; w < all.size(); ++w) {
    const Ps from = all[w].from + taken_at_starts[w] + error;
    const Ps until = all[w].until - lost_at_end - error;
    if (from > until) continue;
    if (windows_.empty()) first_start = from;
    const Ps length = scaled_down(until - from, one, one + fastest_ppt);
    // What is left for frames that end in time, by the worst clock.
    if (const Ps room = scaled_down(until + guard - from, one, one + fastest_ppt); packed && room != room_of_last) {
      room_of_last = room;
      packed_of_last = packed(room);
    }
    const Ps more = std::max<Ps>(0, packed_of_last - length);
    windows_.push_back({windows_.empty() ? 0 : from - end_of_last, length, length + more, more_of_last});
    end_of_last = until;
    more_of_last = more;
  }
  if (windows_.empty()) return;
  windows_.front().gap_before = std::max<Ps>(0, first_start + gates.cycle() - end_of_last);
  windows_.front().lost_first = more_of_last;
  for (Window& window : windows_) {
    // Who has sent more in the window before has waited for so much less.
    window.gap_before =
        std::max<Ps>(0, scaled_up(std::max<Ps>(0, window.gap_before), one, one + slowest_ppt) - window.lost_first);
    usable_ += window.length;
    cycle_ += window.gap_before + window.length;
  }
}

Ps PeriodicSupply::time_for(Ps need) const {
  if (windows_.empty() || !is_bounded(need) || (usable_ == 0 && need > 0)) return unbounded_ps;
  // Worst begins where a window has just ended: earlier in it there would be more of it, later the next one would be
  // nearer.
  const std::int64_t cycles = need > 0 ? (need - 1) / usable_ : 0;
  Ps longest = 0;
  for (std::size_t first = 0; first < windows_.size(); ++first) {
    Ps rest = need - cycles * usable_;
    Ps time = sum(product(cycle_, cycles), windows_[first].lost_first);
    for (std::size_t i = first;; i = (i + 1) % windows_.size()) {
      time = sum(time, windows_[i].gap_before);
      if (rest <= windows_[i].fits) break;
      rest -= std::min(rest, windows_[i].length);  // what does not fit any more begins with the next window
      time = sum(time, windows_[i].length);
    }
    longest = std::max(longest, sum(time, rest));
  }
  return longest;
}

}  // namespace takt::analysis
