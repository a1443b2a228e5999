// SPDX-License-Identifier: Apache-2.0
#include "interchange/gate_times.hpp"

#include "interchange/import.hpp"
#include "models/egress/class_set.hpp"

namespace takt::interchange {

FoldedTime fold_base_time(sim::int128 base_ns, sim::Duration cycle) {
  const sim::int128 base_ps = base_ns * 1000;
  if (base_ns < earliest_running_clock_ns || cycle <= sim::Duration())
    return {sim::Duration::from_ps(static_cast<std::int64_t>(base_ps)), false};
  return {sim::Duration::from_ps(static_cast<std::int64_t>(base_ps % cycle.ps())), true};
}

std::vector<models::GateControlEntry> rotated(const std::vector<models::GateControlEntry>& entries, sim::Duration by) {
  std::vector<models::GateControlEntry> behind, before;
  sim::Duration at;
  for (const models::GateControlEntry& entry : entries) {
    const sim::Duration end = at + entry.interval;
    if (end <= by) {
      before.push_back(entry);
    } else if (at >= by) {
      behind.push_back(entry);
    } else {
      models::GateControlEntry first = entry, second = entry;
      first.interval = by - at;
      second.interval = end - by;
      before.push_back(first);
      behind.push_back(second);
    }
    at = end;
  }
  behind.insert(behind.end(), before.begin(), before.end());
  return behind;
}

Widened widen_short_entries(std::vector<models::GateControlEntry>& entries, sim::Duration least) {
  std::vector<models::GateControlEntry> joined;
  for (const models::GateControlEntry& entry : entries) {
    if (!joined.empty() && joined.back().gate_states == entry.gate_states &&
        entry.operation == models::GateOperation::set_gate_states)
      joined.back().interval += entry.interval;
    else
      joined.push_back(entry);
  }
  Widened widened;
  for (std::size_t i = 0; i < joined.size(); ++i) {
    if (joined[i].interval >= least) continue;
    const sim::Duration missing = least - joined[i].interval;
    if (i > 0 && !models::is_one_class(joined[i - 1].gate_states) &&
        (joined[i].gate_states & ~joined[i - 1].gate_states) == 0 &&
        joined[i].operation == models::GateOperation::set_gate_states && joined[i - 1].interval - missing >= least) {
      joined[i - 1].interval -= missing;
      joined[i].interval = least;
      ++widened.lengthened;
    } else {
      ++widened.too_short;
    }
  }
  if (widened.lengthened + widened.too_short > 0) entries = std::move(joined);
  return widened;
}

DeviceGates device_gates(const models::GateConfig& gates) {
  DeviceGates device;
  device.cycle = gates.admin_cycle_time;
  device.extension = gates.admin_cycle_time_extension;
  sim::Duration sum;
  for (const models::GateControlEntry& entry : gates.admin_control_list) {
    if (sum >= device.cycle) break;
    device.entries.push_back(entry);
    device.entries.back().interval = std::min(entry.interval, device.cycle - sum);
    sum += device.entries.back().interval;
  }
  device.was_filled = sum != device.cycle || device.entries.size() != gates.admin_control_list.size();
  if (!device.entries.empty()) device.entries.back().interval += device.cycle - sum;
  sim::Duration base = gates.admin_base_time.since_start();
  if (base < sim::Duration() && device.cycle > sim::Duration()) {
    sim::Duration within = base % device.cycle;
    if (within < sim::Duration()) within += device.cycle;
    if (gates.is_running && within > sim::Duration()) {
      device.entries = rotated(device.entries, device.cycle - within);
      within = sim::Duration();
    }
    base = within;
  }
  device.base = base;
  return device;
}

}  // namespace takt::interchange
