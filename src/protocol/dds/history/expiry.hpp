// SPDX-License-Identifier: Apache-2.0
// When a change ceases to be wanted (LIFESPAN, DDS 1.4, 2.2.3.16).
#pragma once

#include "dds/message/time.hpp"

namespace takt::dds {

/// Never for an infinite lifespan, whatever the timestamp says: one from another time scale may lie as far before local
/// time 0 as can be said.
constexpr sim::LocalTime expiry_of(sim::LocalTime source, sim::Duration lifespan) {
  if (lifespan == infinite) return sim::LocalTime::never();
  return source.ps() > 0 ? source.plus_saturated(lifespan) : source + lifespan;
}

}  // namespace takt::dds
