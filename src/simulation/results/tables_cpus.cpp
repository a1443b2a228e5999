// SPDX-License-Identifier: Apache-2.0
// What result.json holds of the processors of hosts.
#include "json/record.hpp"
#include "results/cpu_result.hpp"

namespace takt::results {

const json::Record& describe(json::Type<CpuThreadResult>) {
  static constexpr json::Output outputs[] = {
      json::output<&CpuThreadResult::policy>("policy", "How it is scheduled."),
      json::output<&CpuThreadResult::jobs>("jobs", "Jobs that it has done."),
      json::output<&CpuThreadResult::refused>("refused", "Jobs that found too many others waiting."),
      json::output<&CpuThreadResult::late>("late", "Jobs that ended behind the thread's deadline."),
      json::output<&CpuThreadResult::response>(
          "response_ps",
          "From when a job is ready - its message is there, its timer has expired and the operating system has woken "
          "the thread - to its end; null without a job."),
      json::output<&CpuThreadResult::response_p99>("response_p99_ps",
                                                   "99 % of the jobs took no longer; null without a job."),
      json::output<&CpuThreadResult::utilisation>("utilisation",
                                                  "Share of a core's time that it took, with switching."),
  };
  static constexpr json::Record record{"cpu_thread", "A thread of a host.", outputs};
  return record;
}

const json::Record& describe(json::Type<CpuResult>) {
  static constexpr json::Output outputs[] = {
      json::output<&CpuResult::cores>("cores", "How many."),
      json::output<&CpuResult::utilisation>("utilisation", "Share of their time that threads took, with switching."),
      json::outputs_by_name<&CpuResult::threads, &CpuThreadResult::name>("threads", "Those that take time.",
                                                                         {.keys = "thread"}),
  };
  static constexpr json::Record record{"cpu", "The processor of a host.", outputs};
  return record;
}

}  // namespace takt::results
