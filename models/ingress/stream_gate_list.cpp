// SPDX-License-Identifier: Apache-2.0
#include "models/ingress/stream_gate_list.hpp"

namespace takt::models {
namespace {

CyclicIntervals intervals_of(std::span<const StreamGateEntry> entries, sim::Duration cycle_time) {
  std::vector<sim::Duration> intervals;
  intervals.reserve(entries.size());
  for (const StreamGateEntry& entry : entries) intervals.push_back(entry.interval);
  return {intervals, cycle_time};
}

}  // namespace

StreamGateList::StreamGateList(std::span<const StreamGateEntry> entries, sim::Duration cycle_time)
    : intervals_(intervals_of(entries, cycle_time)), entries_(entries.begin(), entries.end()) {}

ConfigChange StreamGateSchedule::request_change(sim::LocalTime now, const AdminConfig& admin) {
  schedule_.move_to(now);
  const ConfigChange change = schedule_.request_change(now, admin);
  schedule_.move_to(now);
  return change;
}

StreamGateState StreamGateSchedule::state(sim::LocalTime now) {
  const Schedule::Place& place = here(now);
  const StreamGateList* const list = schedule_.present().list;
  if (list == nullptr) return {admin_gate_open_, admin_ipv_, std::nullopt, schedule_.present().from};
  const StreamGateEntry& entry = list->entries()[place.entry];
  return {entry.open, entry.ipv, entry.interval_octet_max, schedule_.start_of(place)};
}

sim::LocalTime StreamGateSchedule::next_operation(sim::LocalTime now) {
  here(now);
  return schedule_.here_until();
}

}  // namespace takt::models
