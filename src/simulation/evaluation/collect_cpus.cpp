// SPDX-License-Identifier: Apache-2.0
#include "evaluation/collect_cpus.hpp"

#include "scenario/run/cpu_monitor.hpp"

namespace takt::evaluation {

using namespace results;
namespace {

double share_of(sim::Duration part, sim::Duration whole) {
  return whole > sim::Duration() ? static_cast<double>(part.ps()) / static_cast<double>(whole.ps()) : 0;
}

CpuThreadResult result_of(const models::CpuThreadPlan& thread, const scenario::CpuThreadFigures& figures,
                          sim::Duration whole) {
  CpuThreadResult result;
  result.name = thread.name;
  result.policy = scenario::spelling(static_cast<scenario::SchedulingPolicy>(thread.policy));
  result.jobs = figures.response.count();
  result.refused = figures.refused;
  result.late = figures.late;
  result.utilisation = share_of(figures.ran, whole);
  if (figures.response.empty()) return result;
  result.response = DurationSummary{figures.response.count(), figures.response.minimum(), figures.response.mean(),
                                    figures.response.maximum(), figures.response.standard_deviation()};
  result.response_p99 = figures.response.percentile(99, 100);
  return result;
}

}  // namespace

std::vector<CpuResult> cpus_of(const scenario::Run& run, sim::Duration from) {
  std::vector<CpuResult> results;
  const sim::Duration whole = run.simulation().now().since_start() - from;
  const auto& nodes = run.resolved().plan.nodes;
  for (std::uint32_t n = 0; n < nodes.size(); ++n) {
    const scenario::CpuMonitor* const monitor = run.cpu_monitor(models::NodeIndex{n});
    if (monitor == nullptr) continue;
    CpuResult& result = results.emplace_back();
    result.node = nodes[n].name;
    result.cores = nodes[n].cpu->cores;
    for (std::size_t t = 0; t < nodes[n].cpu->threads.size(); ++t) {
      result.threads.push_back(result_of(nodes[n].cpu->threads[t], monitor->figures(t, from), whole));
      result.utilisation += result.threads.back().utilisation / result.cores;
    }
  }
  return results;
}

}  // namespace takt::evaluation
