#include "scenario/idle/idle.hpp"

#include "scenario/idle/usage.hpp"

namespace takt::scenario {

void tell_idle(const Resolved& resolved, json::Diagnostics& diagnostics) {
  // One for each part of a scenario.
  constexpr void (*tellers[])(const Usage&, json::Diagnostics&) = {tell_idle_egress, tell_idle_gates, tell_idle_queues, tell_idle_ingress, tell_idle_streams,
                                                                   tell_idle_faults, tell_idle_script, tell_idle_clocks, tell_incapable_links, tell_idle_cpus, tell_idle_requirements};
  const Usage usage(resolved);
  for (const auto tell : tellers) tell(usage, diagnostics);
}

}  // namespace takt::scenario
