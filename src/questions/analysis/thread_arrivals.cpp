// SPDX-License-Identifier: Apache-2.0
#include "analysis/thread_arrivals.hpp"

namespace takt::analysis {

ArrivalPattern calls_of(const scenario::ResolvedThread& thread, const ThreadTime& cpu, const ClockQuality& clock) {
  const Ps latest = thread.every.ps() - 1;
  const Ps least = std::min(latest, thread.response.least().ps());
  Ps spread = longest(latest - least, clock);
  // One whose processor may still be at the call before may begin later than it is ready.
  if (!thread.cpu_thread || overtakes_none(thread, cpu, clock))
    spread =
        std::min(spread, sum(longest(std::min(latest, thread.response.greatest().ps()) - least, clock), cpu.spread()));
  // Responses pass on the host's clock, whose instants are whole picoseconds of true time.
  const Ps rounding = clock.slowest_ppt == 0 && clock.fastest_ppt == 0 ? 0 : 1;
  return {std::max<Ps>(1, shortest(thread.every.ps(), clock)), 1, 0, sum(spread, rounding, 2 * clock.error)};
}

}  // namespace takt::analysis
