// SPDX-License-Identifier: Apache-2.0
#include "scenario/programs/observations.hpp"

#include <algorithm>

#include "scenario/programs/program_monitor.hpp"
#include "scenario/programs/role_monitor.hpp"

namespace takt::scenario {

void Observations::handle(sim::Simulation& simulation, const sim::Event&) {
  simulation.uncount_event();
  const auto comes_before = [](const Seen& a, const Seen& b) { return a.when < b.when; };
  if (!std::is_sorted(seen_.begin(), seen_.end(), comes_before))
    std::stable_sort(seen_.begin(), seen_.end(), comes_before);
  for (const Seen& seen : seen_) seen.monitor->judge(seen.what);
  for (const Bound& bound : bindings_) bound.monitor->judge_binding(bound.role, bound.binding);
  seen_.clear();
  bindings_.clear();
}

}  // namespace takt::scenario
