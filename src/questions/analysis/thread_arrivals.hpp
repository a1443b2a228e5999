// SPDX-License-Identifier: Apache-2.0
// When the calls of threads of applications take place: the arrival curve of what they publish.
#pragma once

#include "analysis/by_clock.hpp"
#include "analysis/frame_arrivals.hpp"
#include "analysis/host_times.hpp"
#include "analysis/port_bound.hpp"
#include "scenario/resolved/resolved.hpp"

namespace takt::analysis {

/// Calls of a thread in true time, one in a period. A call whose response is not over when the next one is due does not
/// take place (scenario/applications/activations.hpp), so none is late by a period, whatever the law of its response.
ArrivalPattern calls_of(const scenario::ResolvedThread& thread, const ThreadTime& cpu, const ClockQuality& clock);

}  // namespace takt::analysis
