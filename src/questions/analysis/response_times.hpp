// SPDX-License-Identifier: Apache-2.0
// How long the jobs of threads that share the cores of a host take at most: response-time analysis.
//
// Where all threads that may run on a core are bound to it (or there is but one core): the level-i busy window of
// Lehoczky (1990), after Joseph and Pandya (1986), with release jitter, blocking and several jobs in one window as in
// Tindell, Burns and Wellings (1994). Where threads move between cores: each job of another thread that may be worked
// at while one waits was released no longer before it than that thread's own response time (carry-in, as in Bertogna
// and Cirinei (2007)). docs/cpu.md derives both.
#pragma once

#include <string>
#include <vector>

#include "analysis/frame_arrivals.hpp"
#include "models/host/cpu_plan.hpp"

namespace takt::analysis {

/// Jobs of one kind that a thread gets.
struct JobSource {
  FrameArrivals arrivals;  ///< of jobs
  Ps work = 0;             ///< that each takes at most, without interruptions; > 0
  std::string what = {};   ///< whose they are, for reasons
};

/// The jobs of a thread, from when they are ready to their ends, and that none of them is refused.
struct ThreadTime {
  Ps least = 0;
  Ps worst = 0;             ///< unbounded: not known, or jobs may be refused
  std::string reason = {};  ///< why that is so
  Ps spread() const { return is_bounded(worst) ? worst - least : unbounded_ps; }
  bool operator==(const ThreadTime&) const = default;
};

/// Bounds of all threads of the plan, whose jobs come from these sources, by thread; their execution times are those of
/// the sources. A bound beyond a second is none.
std::vector<ThreadTime> response_times(const models::CpuPlan& plan, const std::vector<std::vector<JobSource>>& jobs);

}  // namespace takt::analysis
