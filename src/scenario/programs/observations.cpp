#include "scenario/programs/observations.hpp"

#include "scenario/programs/program_monitor.hpp"
#include "scenario/programs/role_monitor.hpp"

namespace takt::scenario {

void Observations::settle(sim::Simulation&) {
  for (const Seen& seen : seen_) seen.monitor->judge(seen.what);
  for (const Bound& bound : bindings_) bound.monitor->judge_binding(bound.role, bound.binding);
  seen_.clear();
  bindings_.clear();
}

}  // namespace takt::scenario
