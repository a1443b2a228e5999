// SPDX-License-Identifier: Apache-2.0
#include "scenario/idle/idle.hpp"

#include "scenario/idle/usage.hpp"

namespace takt::scenario {

void report_ineffective(const Resolved& resolved, json::Diagnostics& diagnostics) {
  // One for each part of a scenario.
  constexpr void (*tellers[])(const Usage&, json::Diagnostics&) = {
      report_ineffective_egress,  report_ineffective_gates,  report_ineffective_queues,      report_ineffective_ingress,
      report_ineffective_streams, report_ineffective_faults, report_ineffective_script,      report_ineffective_clocks,
      report_incapable_links,     report_ineffective_cpus,   report_ineffective_requirements};
  const Usage usage(resolved);
  for (const auto tell : tellers) tell(usage, diagnostics);
}

}  // namespace takt::scenario
