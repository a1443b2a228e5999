// SPDX-License-Identifier: Apache-2.0
#include "study/phases.hpp"

#include "sim/random.hpp"
#include "verify/free_phases.hpp"

namespace takt::study {
namespace {

/// From 0 up to the range, without it: a share of 64 bits of it, in whole picoseconds.
sim::Duration share_of(sim::Duration range, std::uint64_t share) {
  return sim::Duration::from_ps(
      static_cast<std::int64_t>(static_cast<sim::uint128>(static_cast<std::uint64_t>(range.ps())) * share >> 64));
}

}  // namespace

scenario::Scenario with_drawn_phases(const scenario::Scenario& scenario) {
  std::vector<verify::FreeVariable> phases;
  verify::add_free_publishers(scenario, phases);
  verify::add_free_talkers(scenario, phases);
  std::erase_if(phases, [](const verify::FreeVariable& phase) { return phase.range <= sim::Duration(); });
  verify::Choice choice{scenario.seed, {}};
  for (const verify::FreeVariable& phase : phases)
    choice.values.push_back(share_of(phase.range, sim::RandomStream(scenario.seed, phase.name, "drawn phase").next()));
  return verify::scenario_of(scenario, phases, choice);
}

}  // namespace takt::study
