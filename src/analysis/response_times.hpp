// How late the jobs of a processor's threads can end, whatever the phases: response-time analysis by busy windows.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "analysis/frame_arrivals.hpp"
#include "models/host/cpu_plan.hpp"

namespace takt::analysis {

/// Jobs that are released for a thread from one cause. A job is submitted to the processor at its release: what makes releases late is jitter of the arrivals.
struct JobSource {
  FrameArrivals arrivals;         ///< jobs that are released in any closed interval of true time
  Ps execution = 0;               ///< of a job at most, without interruptions
};

struct ThreadResponse {
  std::vector<Ps> responses;      ///< by source: from the release of a job to its end at most; unbounded_ps: undecided
  Ps response = 0;                ///< the greatest of them; 0 if there is no source
  std::string reason;             ///< why it is undecided
  std::optional<std::int64_t> most_outstanding;   ///< jobs that wait or are worked at
  bool loses_nothing = false;     ///< no job is refused, since no more are outstanding than the thread keeps
  double utilization = 0;         ///< of a core, in the long run, without switching; infinite if any number may come
  bool is_decided() const { return is_bounded(response); }
};

struct CpuResponses {
  std::vector<ThreadResponse> threads;
  std::vector<double> cores;      ///< by core: utilization by the threads that are bound to it
  double anywhere = 0;            ///< by those that may run anywhere
  double total = 0;               ///< 1.0: all of one core
};

/// `sources`: by thread of the plan. The plan is one that models::Cpu takes; no job takes longer than its source says.
/// Statement and proof: docs/cpu.md.
CpuResponses response_times(const models::CpuPlan& plan, const std::vector<std::vector<JobSource>>& sources);

}  // namespace takt::analysis
