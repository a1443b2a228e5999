// SPDX-License-Identifier: Apache-2.0
#include "interchange/inet/gate_circles.hpp"

#include <algorithm>

namespace takt::interchange::inet {

bool ClassGate::is_open(std::int64_t at) const {
  if (sum == 0) return initially;
  std::int64_t within = (at + offset) % sum;
  bool open = initially;
  for (const std::int64_t length : durations) {
    if (within < length) break;
    within -= length;
    open = !open;
  }
  return open;
}

scenario::Gates one_list(const std::array<ClassGate, 8>& gates, std::int64_t cycle) {
  constexpr std::size_t most_changes = 100'000;  // many more than a list of takt has: told by the caller
  std::vector<std::int64_t> changes = {0};
  for (const ClassGate& gate : gates) {
    if (gate.sum == 0) continue;
    std::int64_t at = -(gate.offset % gate.sum);
    for (std::size_t i = 0; at < cycle && changes.size() < most_changes; i = (i + 1) % gate.durations.size()) {
      if (at > 0) changes.push_back(at);
      at += gate.durations[i];
    }
  }
  std::ranges::sort(changes);
  changes.erase(std::unique(changes.begin(), changes.end()), changes.end());
  scenario::Gates made;
  for (std::size_t i = 0; i < changes.size(); ++i) {
    scenario::GateEntry entry;
    for (std::uint8_t q = 0; q < 8; ++q)
      if (gates[q].is_open(changes[i])) entry.open.push_back(q);
    entry.interval = sim::Duration::from_ps((i + 1 < changes.size() ? changes[i + 1] : cycle) - changes[i]);
    if (!made.entries.empty() && made.entries.back().open == entry.open)
      made.entries.back().interval += entry.interval;
    else
      made.entries.push_back(std::move(entry));
  }
  return made;
}

}  // namespace takt::interchange::inet
