// SPDX-License-Identifier: Apache-2.0
// How many samples a publication brings: what a subscribing thread may expect in a window (criterion 2).
#pragma once

#include <cstdint>

#include "scenario/resolved/resolved.hpp"

namespace takt::scenario {

/// In so long, if nobody misses a call and nothing is lost. A gateway publishes what it got, no more often than it
/// sends: what it may bring follows its sources, through other gateways too.
std::uint64_t values_expected(const Resolved& resolved, const ResolvedInput& publication, Duration window);

/// The longest interval at which one of those publishes on whom the publication rests.
Duration slowest_interval(const Resolved& resolved, const ResolvedInput& publication);

}  // namespace takt::scenario
