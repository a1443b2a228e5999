// SPDX-License-Identifier: Apache-2.0
// The CPU time that this process has used.
#pragma once

#include <sys/resource.h>

#include <cstdint>

namespace takt::study {

/// Microseconds of CPU time, of all threads, in user and kernel mode.
///
/// Not CLOCK_PROCESS_CPUTIME_ID: while a limit of CPU time is set (pool.hpp), Linux answers that clock from a sum that
/// it brings up to date only with its ticks, every 4 ms or so: a point would seem half a tick shorter than it was. What
/// getrusage says is always up to date.
inline std::uint64_t cpu_time_us() {
  rusage used{};
  ::getrusage(RUSAGE_SELF, &used);
  const auto us_of = [](const timeval& time) {
    return static_cast<std::uint64_t>(time.tv_sec) * 1'000'000 + static_cast<std::uint64_t>(time.tv_usec);
  };
  return us_of(used.ru_utime) + us_of(used.ru_stime);
}

}  // namespace takt::study
