// SPDX-License-Identifier: Apache-2.0
#include "models/egress/gate_control_list.hpp"

#include <algorithm>
#include <limits>

namespace takt::models {
namespace {

using sim::Duration;

CyclicIntervals intervals_of(std::span<const GateControlEntry> entries, Duration cycle_time) {
  std::vector<Duration> intervals;
  intervals.reserve(entries.size());
  for (const GateControlEntry& entry : entries) intervals.push_back(entry.interval);
  return {intervals, cycle_time};
}

}  // namespace

GateControlList::GateControlList(std::span<const GateControlEntry> entries, Duration cycle_time)
    : intervals_(intervals_of(entries, cycle_time)), entries_(entries.begin(), entries.end()) {
  ahead_.resize(std::size_t{intervals_.executed()} * traffic_class_count);
  for (TrafficClass q = 0; q < traffic_class_count; ++q) lay_out_gate(q);
  for (TrafficClass q = 0; q < traffic_class_count; ++q) lay_out_windows(q);
  lay_out_hold();
}

void GateControlList::lay_out_gate(TrafficClass q) {
  const std::uint32_t count = intervals_.executed();
  const auto is_open = [&](std::uint32_t i) { return (entries_[i % count].gate_states >> q & 1) != 0; };
  const auto start_ps = [&](std::uint32_t i) {
    return (intervals_.start(i % count) + cycle_time() * static_cast<std::int64_t>(i / count)).ps();
  };
  // Backwards through four cycles: from any entry of the first, the next window ends within three.
  Ahead ahead;
  std::int64_t close_ps = no_toggle_ps;
  for (std::uint32_t i = 4 * count; i-- > 0;) {
    ahead.open = is_open(i);
    if (i + 1 < 4 * count && ahead.open != is_open(i + 1)) {
      ahead.toggle_ps = start_ps(i + 1);
      ahead.toggled_by = static_cast<std::uint16_t>((i + 1) % count);
      if (ahead.open) {
        close_ps = ahead.toggle_ps;
      } else {
        ahead.next_open_ps = ahead.toggle_ps;
        ahead.next_window_ps = close_ps == no_toggle_ps ? -1 : close_ps - ahead.toggle_ps;
      }
    }
    if (i >= count) continue;
    ahead_[i * traffic_class_count + q] = ahead;
    if (!ahead.open) continue;
    open_[q] += intervals_.end_in_cycle(i) - intervals_.start(i);
    const Duration window =
        ahead.toggle_ps == no_toggle_ps ? Duration::max() : Duration::from_ps(ahead.toggle_ps) - intervals_.start(i);
    longest_window_[q] = std::max(longest_window_[q], window);
  }
}

void GateControlList::lay_out_windows(TrafficClass q) {
  const std::uint32_t count = intervals_.executed();
  first_window_[q] = windows_.size();
  if (longest_window_[q] == Duration::max()) {
    windows_.push_back({std::numeric_limits<std::int64_t>::min() / 4, std::numeric_limits<std::int64_t>::max() / 4});
  } else {
    for (std::uint32_t i = 0; i < count; ++i)
      if (ahead(i, q).open && !ahead((i + count - 1) % count, q).open)
        windows_.push_back({intervals_.start(i).ps(), ahead(i, q).toggle_ps});
    if (windows_.size() > first_window_[q] && windows_.back().until_ps > cycle_time().ps()) {
      const Window before{windows_.back().from_ps - cycle_time().ps(), windows_.back().until_ps - cycle_time().ps()};
      windows_.insert(windows_.begin() + static_cast<std::ptrdiff_t>(first_window_[q]), before);
    }
  }
  first_window_[q + 1u] = windows_.size();
}

void GateControlList::lay_out_hold() {
  const std::uint32_t count = intervals_.executed();
  first_hold_or_release_ = count;
  holds_.resize(count);
  bool hold = false;
  for (std::uint32_t i = 0; i < 2 * count; ++i) {  // the first round finds what the second one inherits
    const GateOperation operation = entries_[i % count].operation;
    if (operation != GateOperation::set_gate_states) {
      hold = operation == GateOperation::set_and_hold_mac;
      first_hold_or_release_ = std::min(first_hold_or_release_, i % count);
    }
    holds_[i % count] = hold;
  }
}

}  // namespace takt::models
