// SPDX-License-Identifier: Apache-2.0
// Epoch: what local time 0 is on the clock that stamps samples.
#pragma once

#include "dds/message/time.hpp"

namespace takt::dds {

/// Participants that compare timestamps need one time scale; 0 for all is one, UTC seconds since 1970 is what other
/// implementations use.
struct Epoch {
  std::int32_t seconds = 0;
  constexpr Time stamp(sim::LocalTime time) const {
    Time made = Time::from(time);
    made.seconds += seconds;
    return made;
  }
  /// Saturates where the stamp is from another scale.
  constexpr sim::LocalTime local(Time stamp) const {
    const std::int64_t at = std::int64_t{stamp.seconds} - seconds;
    if (at > 0x7FFF'FFFF || at < -0x7FFF'FFFF) return at > 0 ? sim::LocalTime::never() : sim::LocalTime();
    return Time{static_cast<std::int32_t>(at), stamp.fraction}.to_local();
  }
};

}  // namespace takt::dds
