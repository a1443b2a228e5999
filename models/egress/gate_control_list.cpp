#include "models/egress/gate_control_list.hpp"

#include <algorithm>

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
  executed_.resize(intervals_.executed());
  for (std::uint32_t i = 0; i < intervals_.executed(); ++i) executed_[i].gate_states = entries_[i].gate_states;
  for (TrafficClass q = 0; q < traffic_class_count; ++q) lay_out_gate(q);
  lay_out_hold();
}

void GateControlList::lay_out_gate(TrafficClass q) {
  const std::uint32_t count = intervals_.executed();
  const auto is_open = [&](std::uint32_t i) { return (executed_[i % count].gate_states >> q & 1) != 0; };
  const auto start_ps = [&](std::uint32_t i) {
    return (intervals_.start(i % count) + cycle_time() * static_cast<std::int64_t>(i / count)).ps();
  };
  // Backwards through two cycles: behind any entry of the first, the state changes within as many entries as a cycle has.
  std::int64_t toggle_ps = no_toggle_ps;
  std::uint32_t toggled_by = 0;
  for (std::uint32_t i = 2 * count - 1; i-- > 0;) {
    if (is_open(i) != is_open(i + 1)) {
      toggle_ps = start_ps(i + 1);
      toggled_by = (i + 1) % count;
    }
    if (i >= count) continue;
    executed_[i].toggle_ps[q] = toggle_ps;
    executed_[i].toggled_by[q] = static_cast<std::uint16_t>(toggled_by);
    if (is_open(i)) {
      open_[q] += intervals_.end_in_cycle(i) - intervals_.start(i);
      const Duration window = toggle_ps == no_toggle_ps ? Duration::max() : Duration::from_ps(toggle_ps) - intervals_.start(i);
      longest_window_[q] = std::max(longest_window_[q], window);
    }
  }
  if (count == 1) {  // the loop has nothing to compare: one entry never changes
    executed_[0].toggle_ps[q] = no_toggle_ps;
    executed_[0].toggled_by[q] = 0;
  }
}

void GateControlList::lay_out_hold() {
  const std::uint32_t count = intervals_.executed();
  first_hold_or_release_ = count;
  bool hold = false;
  for (std::uint32_t i = 0; i < 2 * count; ++i) {  // the first round finds what the second one inherits
    const GateOperation operation = entries_[i % count].operation;
    if (operation != GateOperation::set_gate_states) {
      hold = operation == GateOperation::set_and_hold_mac;
      first_hold_or_release_ = std::min(first_hold_or_release_, i % count);
    }
    executed_[i % count].hold = hold;
  }
}

}  // namespace takt::models
