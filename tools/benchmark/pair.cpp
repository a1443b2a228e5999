// SPDX-License-Identifier: Apache-2.0
#include <cstdio>
#include <cstdlib>
#include <string>

#include "measure.hpp"
#include "scenario/resolve.hpp"
#include "scenario/run/run.hpp"
#include "workloads.hpp"

namespace takt::benchmark {

PairFigures run_pair(double simulated_seconds) {
  json::Diagnostics diagnostics;
  const std::string duration = "/duration=" + std::to_string(static_cast<long long>(simulated_seconds * 1e6)) + "us";
  // One start and no further calls: both directions carry state and process data all the time, with every invariant
  // checked.
  const auto resolved = scenario::load_file(
      TAKT_SOURCE_DIR "/scenarios/direct-link.json",
      {duration, R"(/script=[{"at": "1ms", "program": "pair", "call": "Start"}])", "/require=[]"}, diagnostics);
  if (!resolved) {
    std::fputs(diagnostics.to_text().c_str(), stderr);
    std::abort();
  }
  scenario::Run run(*resolved);
  PairFigures figures;
  figures.simulated_seconds = simulated_seconds;
  const double before = cpu_seconds();
  run.advance();
  figures.cpu_seconds = cpu_seconds() - before;
  if (!run.monitor(0).violations().empty() || run.monitor(0).process_data_received() == 0) std::abort();
  return figures;
}

}  // namespace takt::benchmark
