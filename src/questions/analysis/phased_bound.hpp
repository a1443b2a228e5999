// SPDX-License-Identifier: Apache-2.0
// Frames at known phases of a port without gates: who can meet whom at all.
//
// Frame k of a flow comes between first + k * period and `width` later. Take a frame that comes at x, and the busy
// period of its class and the higher ones that it falls into: that begins with an arrival y of one of them, and may be
// blocked by a frame of a lower class that is there just before y. Before the frame go those of its class that may come
// in [y, x] and those of higher classes that may come in [y, start]. With the same frames in between a later y and an
// earlier x are worse. So y is looked at where some frame may come at the latest, or as long before x as the arrival
// curve of what comes at no known phase has jumps, and x where some frame may come at the earliest, or where one of
// those y begins to matter. What links bring (line shaping) counts for the whole stretch between two such instants.
#pragma once

#include <optional>
#include <vector>

#include "analysis/port_bound.hpp"

namespace takt::analysis {

struct PhasedTraffic {
  enum class Role : std::uint8_t { own, before, behind };  ///< of its class, of a higher one, of a lower one
  struct Flow {
    std::optional<ArrivalPhase> phase;  ///< of the clock that is looked at; others come at any time
    const FrameArrivals* arrivals = nullptr;
    std::size_t link = 0;
    Role role = Role::own;
    Ps work = 0;   ///< of a frame, on the medium
    Ps stays = 0;  ///< of lower classes: from the arrival until the medium is free again, at most
  };
  std::vector<Flow> flows;
  std::vector<IncomingLink> links;
  Ps octet_time = 0;
  Ps busy = 0;                ///< no busy period is longer
  std::int64_t rate_ppt = 0;  ///< how far the time of the phases may run from true time
};

/// By flow, the longest wait from arrival to start in true time; unbounded for those of other roles or without a phase.
/// Nothing if there is too much to look at.
std::optional<std::vector<Ps>> waits_by_phases(const PhasedTraffic& traffic);

}  // namespace takt::analysis
