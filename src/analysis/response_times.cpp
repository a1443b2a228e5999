#include "analysis/response_times.hpp"
namespace takt::analysis {
std::vector<ThreadTime> response_times(const models::CpuPlan& plan, const std::vector<std::vector<JobSource>>&) {
  std::vector<ThreadTime> all;
  for (std::size_t i = 0; i < plan.threads.size(); ++i) all.push_back({1, unbounded_ps, "stub"});
  return all;
}
}
