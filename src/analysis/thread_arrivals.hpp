// When the calls of threads of applications take place: the arrival curve of what they publish.
#pragma once

#include "analysis/frame_arrivals.hpp"
#include "analysis/host_times.hpp"
#include "analysis/port_bound.hpp"
#include "scenario/resolve/resolved.hpp"

namespace takt::analysis {

/// A length of a clock's time in true time, at least and at most.
inline Ps shortest(Ps local, const ClockQuality& clock) { return scaled_down(local, one_ppt, one_ppt + clock.fastest_ppt); }
inline Ps longest(Ps local, const ClockQuality& clock) { return scaled_up(local, one_ppt, one_ppt + clock.slowest_ppt); }

/// Calls of a thread in true time, one in a period. A call whose response is not over when the next one is due does not take place (scenario/applications/activations.hpp), so none
/// is late by a period, whatever the law of its response.
ArrivalPattern calls_of(const scenario::ResolvedThread& thread, const ThreadTime& cpu, const ClockQuality& clock);

}  // namespace takt::analysis
