// SPDX-License-Identifier: Apache-2.0
#include <cstdio>
#include <cstdlib>

#include "measure.hpp"
#include "scenario/resolve.hpp"
#include "scenario/run/run.hpp"
#include "study/compare.hpp"
#include "workloads.hpp"

namespace takt::benchmark {

double point_setup(unsigned points) {
  const double before = cpu_seconds();
  for (unsigned i = 0; i < points; ++i) {
    json::Diagnostics diagnostics;
    const auto base = json::parse_file(TAKT_SOURCE_DIR "/scenarios/robot-arm.json", diagnostics);
    if (!base) std::abort();
    const study::Plan plan = study::plain_plan(*base, 1, 1);
    auto scenario = study::scenario_of(plan, {}, i, diagnostics);
    const auto resolved = scenario ? scenario::resolve(std::move(*scenario), diagnostics) : nullptr;
    if (!resolved) std::abort();
    const scenario::Run run(*resolved);
    if (run.simulation().event_count() != 0) std::abort();
  }
  return (cpu_seconds() - before) / points;
}

}  // namespace takt::benchmark
